// The compiled form of a statement: one-byte instructions for a stack machine, operands behind
// them.
//
//   v  variable: 16 bits, a handle of the arena, or LOCAL_FLAG and the place among the locals
//   p  place in code: 24 bits, offset from the arena's base
//   n  one byte, w two bytes (low first), t a length byte and text
//
// Context: main loop.
#ifndef BASIC_CODE_H
#define BASIC_CODE_H

#include <stdint.h>

#define CODE_LOCAL_FLAG 0x8000u

typedef enum {
    OP_STATEMENT,     // w line number (0 at the prompt), w bytes of this statement's code
    OP_END,           // of the program or the line
    OP_FAIL,          // t: the error found while compiling
    OP_INT16,         // w
    OP_INTEGER,       // 8 bytes
    OP_FLOAT,         // 8 bytes
    OP_STRING,        // t
    OP_BLANK,         // an argument left out
    OP_WORD,          // v n t: the variable if it exists (n 1: as a string), else the word
    OP_LITERAL,       // marks the number on the stack as written plainly
    OP_LOAD,          // v
    OP_LOAD_ELEMENT,  // v n subscripts on the stack
    OP_STORE,         // v
    OP_STORE_ELEMENT, // v n; the value on top of the subscripts
    OP_KEEP, // v: stores into a hidden variable, whatever the type; the one behind owns a text
    OP_REF,  // v: a reference to the variable
    OP_REF_ELEMENT, // v n
    OP_REF_ARRAY,   // v
    OP_KNOWN,       // v: 1 if the variable exists, otherwise 0
    OP_CHECK_TYPE,  // v n: the variable, if it exists, must have this type
    OP_ADD,         // the two-operand instructions, in the order of arith_binary()
    OP_SUBTRACT,
    OP_MULTIPLY,
    OP_DIVIDE,
    OP_INT_DIVIDE,
    OP_MOD,
    OP_POWER,
    OP_SHIFT_LEFT,
    OP_SHIFT_RIGHT,
    OP_NOT_EQUAL,
    OP_LESS,
    OP_GREATER,
    OP_LESS_EQUAL,
    OP_GREATER_EQUAL,
    OP_EQUAL,
    OP_AND,
    OP_OR,
    OP_XOR,
    OP_NEGATE,
    OP_NOT,
    OP_INVERT,
    OP_PLUS,
    OP_JUMP,       // p
    OP_JUMP_FALSE, // p
    OP_JUMP_TRUE,  // p
    OP_GOSUB,      // p
    OP_RETURN,
    OP_FOR,           // v, v hidden pair (limit, step), p behind the loop
    OP_NEXT,          // v, v hidden pair, p the loop's body
    OP_CALL,          // w routine, n arguments on the stack above a blank
    OP_LEAVE,         // end of a SUB or FUNCTION
    OP_INDIRECT,      // n kind (indirect.h), n arguments
    OP_FUNCTION,      // n row of functions.c, n arguments
    OP_HOST_FUNCTION, // nn row of the configuration (rows.h), n arguments
    OP_COMMAND,       // nn row of the configuration (rows.h), n arguments
    OP_ASSIGNMENT, // nn row of the configuration (rows.h), n arguments, the last of them the value
    OP_ACTION,     // n row of actions.def, n arguments
    OP_DEADLINE,   // milliseconds on the stack become the time when they have passed
    OP_WAIT,       // until the time on the stack, serving events
    OP_DATA,       // p next DATA or 0, t
} code_op_t;

static inline uint16_t code_u16(const uint8_t *pc) {
    return (uint16_t)(pc[0] | pc[1] << 8);
}

static inline uint32_t code_u24(const uint8_t *pc) {
    return (uint32_t)pc[0] | (uint32_t)pc[1] << 8 | (uint32_t)pc[2] << 16;
}

#endif
