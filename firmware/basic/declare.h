// DIM and LOCAL share their syntax. Context: main loop, while compiling.
#ifndef BASIC_DECLARE_H
#define BASIC_DECLARE_H

#include <stdbool.h>
#include <stdint.h>

// INTEGER, FLOAT or STRING at hand, gone past. Error: something else.
uint8_t declare_type_at_hand(void);

// The list behind DIM (or LOCAL).
void declare_compile(bool local);

#endif
