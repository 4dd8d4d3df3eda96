// Where one is in the text being edited, how one moves there and how the text changes at that
// place. Context: main loop.
#ifndef BASIC_EDITOR_CURSOR_H
#define BASIC_EDITOR_CURSOR_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    size_t place;         // in the text
    size_t line;          // its line, from 0
    size_t wanted_column; // moving up and down tries to keep
    size_t top;           // place of the first line on the screen
    size_t top_line;
    size_t anchor; // where the marked part begins or ends; the other end is `place`
    bool marking;
    bool overwrite;
    bool modified;
    unsigned tab; // columns from one tab stop to the next
} editor_cursor_t;

extern editor_cursor_t editor_cursor;

void editor_cursor_start(unsigned tab);

// Goes to a place in the text.
void editor_cursor_go(size_t place);

// Goes up (negative) or down by lines, in the wanted column.
void editor_cursor_go_lines(long lines);

// Column of a place, tabs counted; the place in the line that starts at `start` which has the
// column, or the nearest before it.
size_t editor_cursor_column(size_t place);
size_t editor_cursor_place_of(size_t start, size_t column);

// How many columns the character at `place` takes in `column`; *size becomes its bytes.
size_t editor_cursor_width(size_t place, size_t column, size_t *size);

// Puts bytes in at the cursor, which goes behind them. False, and nothing is changed, if there is
// no room.
bool editor_cursor_insert(const char *bytes, size_t count);

// Takes bytes out; the cursor is where they were.
void editor_cursor_erase(size_t place, size_t count);

// The marked part; *count is 0 without one.
size_t editor_cursor_marked(size_t *count);

#endif
