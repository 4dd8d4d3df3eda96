// CALL, EVAL and EXECUTE at run time. Text is compiled into the scratch and runs in a frame that
// gives it back; the locals and the place of operands stay those of the routine around it. Context:
// main loop.
#include "indirect.h"

#include <string.h>

#include "calls.h"
#include "compiler.h"
#include "errors.h"
#include "memory.h"
#include "symbols.h"
#include "vm.h"

// ---- CALL ---------------------------------------------------------------------------------------

static const symbols_routine_t *find_routine(const value_t *name) {
    if (name->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    size_t length = name->length;
    bool suffix = length > 0 && memchr("%!$", name->text[length - 1], 3) != NULL;
    const symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, name->text, length - suffix);
    return symbol != NULL ? symbol->routine : NULL;
}

static void call(bool is_function, unsigned count) {
    const symbols_routine_t *routine = find_routine(vm.sp - count - 1);
    if (routine == NULL || routine->is_function != is_function) {
        errors_fail(ERR_NO_USER_SUB);
    }
    calls_enter(routine, count);
}

// ---- EVAL, EXECUTE ------------------------------------------------------------------------------

// Code for the text on top of the stack, in a frame of its own. It ends with the END of `kind`.
static void enter(indirect_kind_t kind, const symbols_routine_t *mark) {
    const value_t *text = vm.sp - 1;
    if (text->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    vm_frame_t *frame = calls_new_frame();
    uint8_t *scratch = memory.scratch;
    const uint8_t *code = compiler_text(text->text, text->length, kind);
    *frame =
        (vm_frame_t){vm.pc, vm.statement, vm.locals, vm.operands, scratch, vm.scratch_base, mark};
    vm.depth++;
    vm.scratch_base = memory.scratch;
    vm.pc = code;
}

// The frame on top, which is one of ours; it is left.
static const vm_frame_t *leave(void) {
    const vm_frame_t *frame = &vm.frames[--vm.depth];
    vm.operands = frame->operands;
    vm.scratch_base = frame->scratch_base;
    memory.scratch = frame->scratch;
    return frame;
}

static void evaluate(void) {
    calls_save_texts(vm.operands, vm.sp - 1);
    enter(INDIRECT_EVAL_END, &calls_eval);
    vm.operands = vm.sp;
}

static void end_evaluate(void) {
    value_t *result = vm.operands - 1;
    *result = vm.sp[-1];
    vm.sp = vm.operands;
    const vm_frame_t *frame = leave();
    if (result->type == VALUE_STRING) { // it may lie in memory just given back: move it up
        char *text = memory_text(result->length);
        memmove(text, result->text, result->length);
        result->text = text;
    }
    vm.pc = frame->return_pc;
}

static void execute(void) {
    enter(INDIRECT_EXECUTE_END, &calls_execute);
    vm.sp--;
}

static void end_execute(void) {
    const vm_frame_t *frame = leave();
    vm.sp = vm.operands;
    vm.statement = frame->statement;
    vm.pc = frame->return_pc;
}

void indirect_run(indirect_kind_t kind, unsigned count) {
    switch (kind) {
    case INDIRECT_SUB:
        call(false, count);
        break;
    case INDIRECT_FUNCTION:
        call(true, count);
        break;
    case INDIRECT_EVAL:
        evaluate();
        break;
    case INDIRECT_EVAL_END:
        end_evaluate();
        break;
    case INDIRECT_EXECUTE:
        execute();
        break;
    case INDIRECT_EXECUTE_END:
        end_execute();
        break;
    }
}

// An EVAL has no statement of its own, so its frame is on top only if the fault is in its
// expression.
void indirect_unwind(void) {
    while (vm.depth > 0 && vm.frames[vm.depth - 1].routine == &calls_eval) {
        leave();
    }
}
