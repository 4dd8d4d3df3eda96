// The text being edited: a gap buffer in memory that the caller lends, lines end with \n. What was
// cut or copied last lies behind it in the same memory. Places are counted in bytes from 0.
// Context: main loop.
#ifndef BASIC_EDITOR_TEXT_H
#define BASIC_EDITOR_TEXT_H

#include <stdbool.h>
#include <stddef.h>

// An empty text in `size` bytes at `memory`; nothing is cut yet.
void editor_text_start(void *memory, size_t size);

size_t editor_text_length(void);
size_t editor_text_room(void);
size_t editor_text_line_ends(void);

// The byte at `place`; '\0' behind the end.
char editor_text_at(size_t place);
void editor_text_copy(size_t place, size_t count, char *bytes);

// False, and nothing is changed, if there is no room. `bytes` may be the clipboard.
bool editor_text_insert(size_t place, const char *bytes, size_t count);
void editor_text_erase(size_t place, size_t count);

// Gives the last `count` bytes of the memory back. False if they are in use.
bool editor_text_shrink(size_t count);

// The text in one piece, valid until the next call.
const char *editor_text_flat(void);

// Start and end (its \n, or the end of the text) of the line that holds `place`.
size_t editor_text_line_start(size_t place);
size_t editor_text_line_end(size_t place);

// How many line ends there are from `place` up to `end`.
size_t editor_text_count_lines(size_t place, size_t end);

// Start of line `line` (from 0), or of the last one.
size_t editor_text_place_of_line(size_t line);

// The start of the character before and behind `place`: UTF-8 is not torn apart.
size_t editor_text_before(size_t place);
size_t editor_text_behind(size_t place);

// The code of the character at `place`, -1 if the bytes are none. *size is how many bytes it has.
int editor_text_character(size_t place, size_t *size);

// Puts a piece of the text to the clipboard. False, and nothing is changed, if there is no room.
bool editor_text_clip(size_t place, size_t count);
const char *editor_text_clipboard(size_t *length);

#endif
