// The operators of expressions. Context: main loop.
#ifndef BASIC_ARITH_H
#define BASIC_ARITH_H

#include "code.h"
#include "value.h"

// values[0] = values[0] op values[1].
void arith_binary(code_op_t op, value_t *values);

// OP_NEGATE, OP_NOT, OP_INVERT, OP_PLUS.
void arith_unary(code_op_t op, value_t *value);

#endif
