// Turns source text into code, once: statement by statement, with names and jumps resolved. A
// statement that does not compile becomes code that raises its error, so a fault shows when (and
// only if) the program gets there. Context: main loop.
#ifndef BASIC_COMPILER_H
#define BASIC_COMPILER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "indirect.h"

// Compiles a program behind its text, which ends where the heap starts now. All names are new.
// Returns the code. Ends by an error if the program is too long.
const uint8_t *compiler_program(const char *text, size_t length);

// Compiles a line typed at the prompt. Ends by an error if the line has one.
const uint8_t *compiler_line(const char *text, size_t length);

// Compiles statements, or an expression, that a program gives as text while it runs. `end` is the
// instruction behind the code: INDIRECT_EXECUTE_END or INDIRECT_EVAL_END. Errors: those of the
// text.
const uint8_t *compiler_text(const char *text, size_t length, indirect_kind_t end);

// ---- For the statements -------------------------------------------------------------------------

// Compiles the statement at the token at hand, and goes to its end.
void compiler_statement(void);

// True while a line from the prompt is compiled.
bool compiler_at_prompt(void);

// True if it is not a program that is compiled: a line from the prompt, or text for EXECUTE and
// EVAL.
bool compiler_is_loose(void);

// Where the statement being compiled starts.
uint32_t compiler_statement_start(void);

// For code that no source statement stands for: returns its start, which the end needs.
uint32_t compiler_begin_statement(void);
void compiler_end_statement(uint32_t start);

// Ends the statement and starts another one, for those that jump before they compute.
void compiler_new_statement(void);

// Remembers a DATA statement's operand; places of DATA are chained for READ.
void compiler_link_data(void);

// Makes the statement that starts at `place` raise this error, because its block was never closed.
void compiler_spoil(uint32_t place, int code);

// The same for a SUB or FUNCTION: the program goes on behind it, and a call of it, which is to
// start at the place returned, meets the error and comes back.
uint32_t compiler_spoil_routine(uint32_t place, int code);

#endif
