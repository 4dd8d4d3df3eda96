// Frames of SUBs, FUNCTIONs and GOSUBs. The arguments on the stack become the routine's first local
// variables where they lie. Context: main loop.
#include "calls.h"

#include <string.h>

#include "errors.h"
#include "events.h"
#include "memory.h"
#include "variables.h"
#include "vm.h"

#define STACK_MARGIN 8  // places an expression in the routine has at least
#define FRAMES_MARGIN 8 // calls that the SUB of an event may nest

const symbols_routine_t calls_execute, calls_eval;

vm_frame_t *calls_new_frame(void) {
    if (vm.depth >= VM_FRAMES_MAX) {
        errors_fail_with(ERR_NESTED_TOO_DEEP, "calls");
    }
    return &vm.frames[vm.depth];
}

// Gives a place a string variable of its own with this text.
static void own_string(value_t *value, const char *text, size_t length) {
    char *bytes = memory_text(VALUE_STRING_MAX + 1);
    bytes[0] = (char)length;
    memcpy(bytes + 1, text, length);
    value->data = bytes;
    value->capacity = VALUE_STRING_MAX;
    value->type = VALUE_STRING_REF;
}

static void set_default(value_t *value, uint8_t type) {
    value->flags = 0;
    if (type == VALUE_STRING) {
        own_string(value, "", 0);
    } else {
        value->integer = 0;
        value->type = type;
    }
}

static void bind_array(const value_t *argument, uint8_t type, unsigned number) {
    if (argument->type != VALUE_ARRAY ||
        ((const variables_array_t *)argument->data)->type != (type & ~SYMBOLS_ARRAY_FLAG)) {
        errors_fail_with(ERR_INCOMPATIBLE_TYPE, "argument %u", number);
    }
}

// Makes an argument what the parameter says: a reference stays one if its type fits.
static void bind(value_t *argument, uint8_t type, unsigned number) {
    static const uint8_t reference_to[] = {
        [VALUE_FLOAT] = VALUE_FLOAT_REF,
        [VALUE_INTEGER] = VALUE_INTEGER_REF,
        [VALUE_STRING] = VALUE_STRING_REF,
    };
    if (argument->type == VALUE_NONE) {
        set_default(argument, type);
        return;
    }
    if (argument->type == reference_to[type]) {
        return;
    }
    if (argument->type == VALUE_ARRAY) {
        errors_fail_with(ERR_INCOMPATIBLE_TYPE, "argument %u", number);
    }
    value_fetch(argument);
    if ((argument->type == VALUE_STRING) != (type == VALUE_STRING)) {
        errors_fail_with(ERR_INCOMPATIBLE_TYPE, "argument %u", number);
    }
    if (type == VALUE_STRING) {
        own_string(argument, argument->text, argument->length);
    } else if (type == VALUE_INTEGER) {
        value_set_integer(argument, value_to_integer(argument));
    } else {
        value_set_number(argument, value_to_number(argument));
    }
    argument->flags = 0;
}

// An array, or BYVAL.
static void bind_specially(value_t *argument, uint8_t type, unsigned number) {
    if (type & SYMBOLS_ARRAY_FLAG) {
        bind_array(argument, type, number);
        return;
    }
    if (argument->type != VALUE_ARRAY) {
        value_fetch(argument);
    }
    bind(argument, (uint8_t)(type & ~SYMBOLS_VALUE_FLAG), number);
}

void calls_save_texts(value_t *from, const value_t *end) {
    for (value_t *value = from; value < end; value++) {
        const uint8_t *text = (const uint8_t *)value->text;
        bool temporary = text >= memory.scratch && text < vm.scratch_base;
        if (value->type == VALUE_STRING && !temporary) {
            char *copy = memory_text(value->length);
            memcpy(copy, value->text, value->length);
            value->text = copy;
        }
    }
}

void calls_enter(const symbols_routine_t *routine, unsigned count) {
    vm_frame_t *frame = calls_new_frame();
    value_t *locals = vm.sp - count - 1;
    if (routine->code == 0) { // its first line did not compile
        errors_fail(ERR_NO_USER_SUB);
    }
    if (count > routine->parameters) {
        errors_fail(ERR_ARGUMENT_LIST);
    }
    if (locals + routine->locals + STACK_MARGIN > memory.values_limit) {
        errors_fail(ERR_NO_MEMORY);
    }
    calls_save_texts(vm.operands, locals);
    uint8_t *scratch = memory.scratch;
    for (unsigned i = 0; i < routine->parameters; i++) {
        value_t *argument = &locals[1 + i];
        uint8_t type = routine->parameter_types[i];
        if (i >= count) {
            argument->type = VALUE_NONE;
        }
        if (type & (SYMBOLS_ARRAY_FLAG | SYMBOLS_VALUE_FLAG)) {
            bind_specially(argument, type, i + 1);
        } else {
            bind(argument, type, i + 1);
        }
    }
    for (unsigned i = 1u + routine->parameters; i < routine->locals; i++) {
        locals[i] = (value_t){.type = VALUE_NONE};
    }
    set_default(&locals[0], routine->is_function ? routine->type : VALUE_INTEGER);

    *frame = (vm_frame_t){vm.pc,   vm.statement,    vm.locals, vm.operands,
                          scratch, vm.scratch_base, routine};
    vm.depth++;
    vm.locals = locals;
    vm.operands = vm.sp = locals + routine->locals;
    vm.scratch_base = memory.scratch;
    vm.pc = memory.base + routine->code;
}

bool calls_have_room(const symbols_routine_t *routine) {
    const value_t *top = vm.sp + 1 + routine->locals + STACK_MARGIN;
    return vm.depth + FRAMES_MARGIN <= VM_FRAMES_MAX && top <= memory.values_limit;
}

static bool is_routine(const symbols_routine_t *routine) {
    return routine != NULL && routine != &calls_execute && routine != &calls_eval;
}

void calls_leave(void) {
    while (vm.depth > 0 && !is_routine(vm.frames[vm.depth - 1].routine)) {
        vm.depth--; // GOSUBs the routine did not return from, EXECUTEs that say EXIT SUB
    }
    if (vm.depth == 0) {
        errors_fail(ERR_NO_RETURN);
    }
    bool interrupt = vm.depth == vm.interrupt_depth;
    const vm_frame_t *frame = &vm.frames[--vm.depth];
    value_t *result = vm.locals;
    memory.scratch = frame->scratch;
    vm.sp = result;
    if (frame->routine->is_function) {
        value_fetch(result);
        if (result->type == VALUE_STRING) { // it lies in memory just given back: move it up
            char *text = memory_text(result->length);
            memmove(text, result->text, result->length);
            result->text = text;
        }
        vm.sp++;
    }
    vm.locals = frame->locals;
    vm.operands = frame->operands;
    vm.scratch_base = frame->scratch_base;
    vm.statement = frame->statement;
    vm.pc = frame->return_pc;
    if (interrupt) {
        events_left();
    }
}

const symbols_routine_t *calls_routine(void) {
    for (unsigned i = vm.depth; i-- > 0;) {
        if (is_routine(vm.frames[i].routine)) {
            return vm.frames[i].routine;
        }
    }
    return NULL;
}

void calls_gosub(const uint8_t *return_pc) {
    vm_frame_t *frame = calls_new_frame();
    *frame = (vm_frame_t){.return_pc = return_pc};
    vm.depth++;
}

const uint8_t *calls_return(void) {
    if (vm.depth == 0 || vm.frames[vm.depth - 1].routine != NULL) {
        errors_fail(ERR_NO_RETURN);
    }
    return vm.frames[--vm.depth].return_pc;
}
