// The lines typed last, in a ring of bytes. Context: main loop.
#ifndef BASIC_HISTORY_H
#define BASIC_HISTORY_H

#include <stddef.h>

void history_clear(void);

// Remembers a line (without zeros in it) unless it is empty or the same as the last.
void history_add(const char *line, size_t length);

// The line `age` steps back, 1 being the last, copied to `line` (at least `size` bytes, cut there).
// Returns its length, 0 if there is none so old.
size_t history_get(unsigned age, char *line, size_t size);

#endif
