// Arguments of the configuration's commands and functions: from the text of a statement, by way of
// code, to the basic_arg_t a handler gets. Context: main loop.
#ifndef BASIC_ARGS_H
#define BASIC_ARGS_H

#include <stdbool.h>

#include "basic/basic.h"
#include "lexer.h"
#include "value.h"

// ---- Compiling ----------------------------------------------------------------------------------

// The word at hand is the first of row `row`'s name; true if further words make one of the rows'
// names whole.
bool args_fits_command(int row);

// The word at hand is the first of row `row`'s name: finds the longest name that fits and compiles
// the arguments. Errors: unknown subcommand, missing argument, too many.
void args_compile_command(int row);

// The same for a function and its parentheses.
void args_compile_function(int row);

// True for GP0, GP1 ...
bool args_is_pin_name(const lexer_token_t *name);

// A BASIC_ARG_ROUTINE of a statement of the language; args_routine() makes its value a routine.
void args_compile_routine(void);

// The same for an assignment to a function: NAME(arguments) = value.
void args_compile_assignment(int row);

// ---- Running ------------------------------------------------------------------------------------

// `row` is where the code names the row.
void args_run(const uint8_t *row, const value_t *values, unsigned count);

// The value to be assigned is the last of `values`.
void args_assign(const uint8_t *row, value_t *values, unsigned count);

// Leaves the result in values[0].
void args_evaluate(const uint8_t *row, value_t *values, unsigned count);

// The SUB that a value names, 0 for the number 0. Errors: no such SUB, it has parameters.
basic_routine_t args_routine(const char *name, const value_t *value);

// Checks and converts `count` values by the specification. Error: names the argument and its range.
void args_deliver(const basic_arg_spec_t *specs, size_t spec_count, const value_t *values,
                  unsigned count, basic_arg_t *out, size_t *out_count);

// The last one of the list is a BASIC_ARG_DATA.
bool args_takes_data(const basic_arg_spec_t *specs, size_t count);

// What a number or a choice may be, in words: "above 0 to 100000", "X, Y, Z, A".
void args_describe_range(const basic_arg_spec_t *spec, char *buffer, size_t size);

// A limit or default in full digits; the buffer has NUMBER_TEXT_SIZE bytes.
void args_format_limit(char *buffer, double limit);

#endif
