// A line being typed as it stands on the screen, over several rows if it is long. Places are bytes
// of the line; a character of UTF-8 is one cell. Context: main loop.
#ifndef BASIC_LINE_SCREEN_H
#define BASIC_LINE_SCREEN_H

#include <stdbool.h>
#include <stddef.h>

// The line (valid meanwhile, empty) begins where the screen's cursor is.
void line_screen_start(const char *line);

// True if the byte is not the first of a character.
bool line_screen_continues(char byte);

// Writes the line from where the screen's cursor is, `from`, up to `to`.
void line_screen_write(size_t from, size_t to);

// Moves the screen's cursor from one place to an earlier one.
void line_screen_back(size_t from, size_t to);

// Draws the line of `length` bytes from `from` on, where the screen's cursor is, and leaves it at
// `cursor`.
void line_screen_draw(size_t from, size_t length, size_t cursor);

// With the screen's cursor at `cursor`: takes the line and `prompt` off the screen, if nothing else
// stands before them; otherwise goes below.
void line_screen_hide(size_t cursor, size_t length, const char *prompt);

// True if the line goes on below the row of `cursor`.
bool line_screen_has_rows_below(size_t cursor, size_t length);

#endif
