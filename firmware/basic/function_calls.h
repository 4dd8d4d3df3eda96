// Compiles calls of the built-in functions. Context: main loop, while compiling.
#ifndef BASIC_FUNCTION_CALLS_H
#define BASIC_FUNCTION_CALLS_H

// The name at hand is row `row` of functions_table: compiles it and its parentheses.
void function_calls_compile(int row);

#endif
