// The screen of a VT100 terminal as cells. What is drawn is compared with what stands there, and
// only the difference is sent. The last column stays empty: terminals differ in what happens there.
// Context: main loop.
#ifndef BASIC_EDITOR_SCREEN_H
#define BASIC_EDITOR_SCREEN_H

#include <stdbool.h>
#include <stddef.h>

typedef enum {
    EDITOR_SCREEN_TEXT,
    EDITOR_SCREEN_INVERSE,
    EDITOR_SCREEN_KEYWORD,
    EDITOR_SCREEN_STRING,
    EDITOR_SCREEN_NUMBER,
    EDITOR_SCREEN_COMMENT,
} editor_screen_look_t;

// Bytes that a screen of this size needs.
size_t editor_screen_size(unsigned rows, unsigned columns);

// Clears the terminal. `memory` (2-aligned) is for `rows` and `columns`.
void editor_screen_start(void *memory, unsigned rows, unsigned columns);

unsigned editor_screen_rows(void);
unsigned editor_screen_columns(void); // without the last one

// A row is put together cell by cell, from the left; what is missing at its end is blank.
void editor_screen_put(int code, editor_screen_look_t look);
void editor_screen_print(const char *text, editor_screen_look_t look); // ASCII
void editor_screen_fill(unsigned column, editor_screen_look_t look);   // blanks up to it
void editor_screen_end_row(unsigned row);
unsigned editor_screen_column(void);

// Moves the rows from `first` up to `end` (excluded) by `lines`: up if it is negative, else down.
// What comes in is blank.
void editor_screen_shift(unsigned first, unsigned end, int lines);

// Where the terminal's cursor is to stand. Sent at once.
void editor_screen_set_cursor(unsigned row, unsigned column);

// Leaves the terminal clear and as it was before.
void editor_screen_finish(void);

#endif
