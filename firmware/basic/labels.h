// Labels and line numbers: where GOTO, GOSUB and RESTORE lead. Context: main loop, while compiling.
#ifndef BASIC_LABELS_H
#define BASIC_LABELS_H

#include <stddef.h>
#include <stdint.h>

#include "code.h"

// Emits a jump (OP_JUMP, OP_GOSUB) to the label or line number at hand.
void labels_jump(code_op_t op);

// Emits a constant whose first three bytes are the place of the label at hand, for RESTORE.
void labels_operand(void);

// A label stands here. Error: it is defined already.
void labels_define(const char *name, size_t length);

// Code from `place` on was taken back: nothing in it waits for a label any more.
void labels_forget(uint32_t place);

// Tells all jumps their places; those without a label go to code that raises the error.
void labels_resolve(uint32_t no_line_number, uint32_t no_label);

#endif
