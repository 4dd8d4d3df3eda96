// Compiles expressions: a Pratt parser over a table of operators. Context: main loop, while
// compiling.
#ifndef BASIC_EXPRESSIONS_H
#define BASIC_EXPRESSIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "code.h"

// An expression from the token at hand on. Errors: syntax, too complex.
void expressions_compile(void);

// The same, but an = behind it does not belong to it.
void expressions_compile_before_equals(void);

// The string at hand, its escapes replaced; gone past.
void expressions_compile_text(void);

// An argument of a SUB or FUNCTION: a variable alone is passed by reference.
void expressions_compile_argument(void);

// The name of a variable; emits the check of its type if one is needed and returns the variable.
uint16_t expressions_compile_name(void);

// `( a, b ... )` up to and with the closing parenthesis; returns how many there were.
unsigned expressions_compile_subscripts(void);

// Arguments of a routine up to the end of the statement or `)`; returns how many. Blanks are
// allowed except as the first and the last. Errors: argument list.
unsigned expressions_compile_arguments(int closing);

// A variable or element to write to, as a reference on the stack.
void expressions_compile_reference(void);

// The same, or name() for a whole array.
void expressions_compile_reference_or_array(void);

// `name()` or `name(subscripts)` or `name`; leaves the value, or with `reference` a reference.
// `arrays`: name() is allowed and is the whole array.
void expressions_compile_variable(bool reference, bool arrays);

// Forgets the nesting an error left.
void expressions_start(void);

// Around whatever calls itself while compiling, so that the C stack suffices. Error: too complex.
#define EXPRESSIONS_PARENTHESIS 3 // weight of parentheses, besides the expression inside
void expressions_enter(unsigned weight);
void expressions_leave(unsigned weight);

#endif
