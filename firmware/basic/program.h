// The program in memory: its text, as typed, and its code. Context: main loop.
#ifndef BASIC_PROGRAM_H
#define BASIC_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

// No program; all variables are gone.
void program_clear(void);

// Makes a copy of `text` (which may lie anywhere, the free part of the arena included) the program:
// line ends become \n. All variables are gone. ERR_OK, or why it does not fit (then there is none).
err_t program_set(const char *text, size_t length);

// Compiles it afresh, which forgets all variables. NULL if it is empty.
const uint8_t *program_prepare(void);

const char *program_text(void);
size_t program_length(void);

// Line `number` (from 1) without its end; NULL if there is none.
const char *program_line(unsigned number, size_t *length);

#endif
