// Escapes in strings, after OPTION ESCAPE. Context: main loop, while compiling.
#ifndef BASIC_ESCAPES_H
#define BASIC_ESCAPES_H

#include <stddef.h>

// Replaces \n, \r, \t, \x41 and the like in `length` characters at `from`; `to` is as large.
// Returns the new length. Error: an unknown one.
size_t escapes_replace(char *to, const char *from, size_t length);

#endif
