// What a name means at the place being compiled: a local of the routine, or a variable of the program.
// Context: main loop, while compiling.
#ifndef BASIC_NAMES_H
#define BASIC_NAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "lexer.h"
#include "symbols.h"

// Outside any routine from here on.
void names_start(void);

// Between SUB or FUNCTION and its end. `handle` is the routine's symbol.
void names_begin_routine(symbols_t *symbol);
void names_end_routine(void);

// The type of the FUNCTION's value, if AS says it.
void names_set_result_type(uint8_t type);

// After a SUB or FUNCTION line that failed: back to `symbol`, or NULL for outside.
void names_restore(symbols_t *symbol);

// The routine being compiled; NULL outside.
symbols_t *names_routine(void);

// Handle of the symbol as scope of labels; 0 outside.
uint16_t names_scope(void);

// The variable of this name, made if needed. `check_type` becomes the type it has to be checked for
// at run time, VALUE_NONE if that is settled. Error: another type already declared.
uint16_t names_variable(const lexer_token_t *name, uint8_t *check_type);

// The variable of the program, whatever locals there are; for DIM and CONST.
uint16_t names_global(const lexer_token_t *name, uint8_t type);

// A new local of the routine. Errors: not in a routine, declared twice, too many.
uint16_t names_local(const lexer_token_t *name, uint8_t type);

// `count` variables without a name, side by side.
uint16_t names_hidden(unsigned count);

// What OPTION DEFAULT is where the compiler stands.
void names_set_default_type(uint8_t type);
uint8_t names_default_type(void);

#endif
