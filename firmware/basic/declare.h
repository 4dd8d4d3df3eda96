// DIM, LOCAL and STATIC share their syntax. Context: main loop, while compiling.
#ifndef BASIC_DECLARE_H
#define BASIC_DECLARE_H

#include <stdbool.h>
#include <stdint.h>

// INTEGER, FLOAT or STRING at hand, gone past. Error: something else.
uint8_t declare_type_at_hand(void);

typedef enum { DECLARE_DIM, DECLARE_LOCAL, DECLARE_STATIC } declare_kind_t;

// The list behind the word.
void declare_compile(declare_kind_t kind);

// The list behind REDIM [PRESERVE].
void declare_compile_again(bool preserve);

#endif
