// Long lists on the terminal, a screen at a time. Context: main loop.
#ifndef BASIC_PAGER_H
#define BASIC_PAGER_H

#include <stdbool.h>
#include <stddef.h>

// A list starts. `all`: without a stop.
void pager_start(bool all);

// Prints a line and its end; before it, if the screen is full, waits for a key. False: the user
// wants no more (q or Ctrl-C).
bool pager_line(const char *text, size_t length);

#endif
