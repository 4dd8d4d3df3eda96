// What a name means at the place being compiled: a local of the routine, or a variable of the
// program. Context: main loop, while compiling.
#ifndef BASIC_NAMES_H
#define BASIC_NAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "lexer.h"
#include "symbols.h"

// A program whose text is `source`; outside any routine.
void names_start(const char *source);

// Text that is compiled while `routine` runs (NULL: outside any), for EXECUTE and the prompt: its
// locals are those it has, and hidden variables live no longer than the code.
void names_start_loose(const symbols_routine_t *routine);

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

// A variable of the routine that outlives its calls. Errors as for names_local().
uint16_t names_static(const lexer_token_t *name);
void names_set_static_type(uint16_t variable, uint8_t type);

// The name of place `index` of a routine's locals as in the source; "" for a hidden one.
const char *names_of_local(const symbols_routine_t *routine, unsigned index, size_t *length);

// `count` variables without a name, side by side.
uint16_t names_hidden(unsigned count);

// What OPTION DEFAULT is where the compiler stands.
void names_set_default_type(uint8_t type);
uint8_t names_default_type(void);

#endif
