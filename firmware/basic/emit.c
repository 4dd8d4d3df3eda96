// Writes code into the arena. Context: main loop, while compiling.
#include "emit.h"

#include <string.h>

#include "errors.h"
#include "memory.h"

#define RESERVE 64u // bytes kept free between code and names

#define PATCHES_MAX 40

static struct {
    uint8_t *next;
    uint8_t *limit; // NULL: a program, which ends at the scratch
    uint8_t *last;
    struct {
        uint32_t chain;
        uint32_t place;
    } patches[PATCHES_MAX]; // of the statement being compiled
    unsigned patch_count;
} emit;

void emit_start_program(void) {
    emit.next = memory.heap;
    emit.limit = NULL;
    emit.last = NULL;
    emit.patch_count = 0;
}

void emit_start_line(uint8_t *buffer, size_t size) {
    emit.next = buffer;
    emit.limit = buffer + size;
    emit.last = NULL;
    emit.patch_count = 0;
}

static void set_next(uint8_t *next) {
    emit.next = next;
    if (emit.limit == NULL) {
        memory.heap = next;
    }
}

// Takes room for `size` more bytes.
static uint8_t *reserve(size_t size) {
    uint8_t *place = emit.next;
    const uint8_t *limit = emit.limit != NULL ? emit.limit : memory.scratch;
    if (place + size + RESERVE > limit) {
        errors_fail(emit.limit != NULL ? ERR_TOO_COMPLEX : ERR_PROGRAM_TOO_LONG);
    }
    set_next(place + size);
    return place;
}

void emit_byte(unsigned byte) {
    *reserve(1) = (uint8_t)byte;
}

void emit_op(code_op_t op) {
    emit.last = emit.next;
    emit_byte(op);
}

void emit_u16(unsigned word) {
    emit_byte(word & 0xFF);
    emit_byte(word >> 8 & 0xFF);
}

void emit_place(uint32_t place) {
    emit_u16(place & 0xFFFF);
    emit_byte(place >> 16);
}

void emit_text(const char *text, size_t length) {
    if (length > VALUE_STRING_MAX) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    emit_byte((unsigned)length);
    memcpy(reserve(length), text, length);
}

static void emit_eight(const void *bytes) {
    memcpy(reserve(8), bytes, 8);
}

void emit_integer(int64_t integer) {
    if (integer == (int16_t)integer) {
        emit_op(OP_INT16);
        emit_u16((uint16_t)integer);
    } else {
        emit_op(OP_INTEGER);
        emit_eight(&integer);
    }
}

void emit_constant(const value_t *value) {
    if (value->type == VALUE_INTEGER) {
        emit_integer(value->integer);
    } else {
        emit_op(OP_FLOAT);
        emit_eight(&value->number);
    }
}

void emit_string(const char *text, size_t length) {
    emit_op(OP_STRING);
    emit_text(text, length);
}

void emit_variable(code_op_t op, uint16_t variable) {
    emit_op(op);
    emit_u16(variable);
}

void emit_element(code_op_t op, uint16_t variable, unsigned subscripts) {
    emit_variable(op, variable);
    emit_byte(subscripts);
}

void emit_action(actions_t action, unsigned arguments) {
    emit_op(OP_ACTION);
    emit_byte(action);
    emit_byte(arguments);
}

void emit_indirect(indirect_kind_t kind, unsigned arguments) {
    emit_op(OP_INDIRECT);
    emit_byte(kind);
    emit_byte(arguments);
}

void emit_jump_to(code_op_t op, uint32_t place) {
    emit_op(op);
    emit_place(place);
}

uint32_t emit_here(void) {
    return memory_offset(emit.next);
}

void emit_wait(uint32_t *chain) {
    uint32_t here = emit_here();
    emit_place(*chain);
    *chain = here;
}

void emit_jump(code_op_t op, uint32_t *chain) {
    emit_op(op);
    emit_wait(chain);
}

void emit_patch_to(uint32_t chain, uint32_t place) {
    while (chain != 0) {
        uint8_t *operand = memory.base + chain;
        chain = code_u24(operand);
        operand[0] = (uint8_t)place;
        operand[1] = (uint8_t)(place >> 8);
        operand[2] = (uint8_t)(place >> 16);
    }
}

void emit_patch(uint32_t *chain) {
    emit.last = NULL;
    if (*chain == 0) {
        return;
    }
    if (emit.patch_count == PATCHES_MAX) {
        errors_fail(ERR_TOO_COMPLEX);
    }
    emit.patches[emit.patch_count].chain = *chain;
    emit.patches[emit.patch_count++].place = emit_here();
    *chain = 0;
}

void emit_commit(void) {
    for (unsigned i = 0; i < emit.patch_count; i++) {
        emit_patch_to(emit.patches[i].chain, emit.patches[i].place);
    }
    emit.patch_count = 0;
}

void emit_rollback(uint32_t place) {
    emit.patch_count = 0;
    emit.last = NULL;
    set_next(memory.base + place);
}

code_op_t emit_last(void) {
    return emit.last != NULL ? (code_op_t)*emit.last : OP_STATEMENT;
}

void emit_change_last(code_op_t op) {
    *emit.last = (uint8_t)op;
}

void emit_forget_last(void) {
    emit.last = NULL;
}

void emit_set_u16(uint32_t place, unsigned word) {
    memory.base[place] = (uint8_t)word;
    memory.base[place + 1] = (uint8_t)(word >> 8);
}

void emit_set_jump(uint32_t place, uint32_t target) {
    memory.base[place] = OP_JUMP;
    memory.base[place + 1] = (uint8_t)target;
    memory.base[place + 2] = (uint8_t)(target >> 8);
    memory.base[place + 3] = (uint8_t)(target >> 16);
}
