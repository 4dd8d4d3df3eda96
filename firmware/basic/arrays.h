// ERASE and REDIM: variables whose memory goes or changes while a program runs. Context: main loop.
#ifndef BASIC_ARRAYS_H
#define BASIC_ARRAYS_H

#include <stdbool.h>
#include <stdint.h>

#include "value.h"

// The variable does not exist any more. Errors: it does not now, or something still refers to it.
void arrays_erase(uint16_t variable);

// All variables of the program. Error: a routine is running, whose arguments may refer to some.
void arrays_erase_all(void);

// Gives an array new bounds; with `preserve` elements that both have keep their value. `type` and
// `capacity` as before if VALUE_NONE and 0. Errors: another type, it is in use, not enough memory.
void arrays_redim(uint16_t variable, uint8_t type, unsigned capacity, const value_t *bounds,
                  unsigned dimensions, bool preserve);

#endif
