// Writes code. Context: main loop, while compiling.
#ifndef BASIC_EMIT_H
#define BASIC_EMIT_H

#include <stddef.h>
#include <stdint.h>

#include "actions.h"
#include "code.h"
#include "indirect.h"
#include "value.h"

// Code goes to the start of the heap until emit_finish() (a program) or to `size` bytes at
// `buffer`.
void emit_start_program(void);
void emit_start_line(uint8_t *buffer, size_t size);

void emit_op(code_op_t op);
void emit_byte(unsigned byte);
void emit_u16(unsigned word);
void emit_place(uint32_t place);
void emit_text(const char *text, size_t length);

// Instructions with their operands.
void emit_integer(int64_t integer);
void emit_constant(const value_t *value);
void emit_string(const char *text, size_t length);
void emit_variable(code_op_t op, uint16_t variable);
void emit_element(code_op_t op, uint16_t variable, unsigned subscripts);
void emit_action(actions_t action, unsigned arguments);
void emit_indirect(indirect_kind_t kind, unsigned arguments);
void emit_jump_to(code_op_t op, uint32_t place);

// Where the next instruction comes.
uint32_t emit_here(void);

// A jump to a place not known yet: put into the chain of those that wait for the same place.
void emit_jump(code_op_t op, uint32_t *chain);
void emit_wait(uint32_t *chain); // only the operand

// Tells a chain that its place is here, once the statement has proved right: emit_commit() does it,
// emit_rollback() takes everything back to `place`, where the statement started.
// Error: more chains than one statement can have.
void emit_patch(uint32_t *chain);
void emit_commit(void);
void emit_rollback(uint32_t place);

// Tells a chain its place at once.
void emit_patch_to(uint32_t chain, uint32_t place);

// The instruction written last, if it is the whole of what was compiled since emit_forget_last():
// for a variable that turns out to be an argument by reference. OP_STATEMENT otherwise.
code_op_t emit_last(void);
void emit_change_last(code_op_t op);
void emit_forget_last(void);

// Overwrites two bytes at `place`.
void emit_set_u16(uint32_t place, unsigned word);
// Overwrites the instruction at `place` by a jump to `target`.
void emit_set_jump(uint32_t place, uint32_t target);

#endif
