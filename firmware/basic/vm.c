// The instruction loop. Context: main loop.
#include "vm.h"

#include <math.h>
#include <string.h>

#include "actions.h"
#include "args.h"
#include "arith.h"
#include "calls.h"
#include "code.h"
#include "console.h"
#include "errors.h"
#include "events.h"
#include "functions.h"
#include "hal/hal.h"
#include "indirect.h"
#include "trace.h"
#include "variables.h"

// Statements between two looks for input of which the board has said nothing (what was left in its
// buffers), between two times that output is sent, and two turns of the background.
#define POLL_EVERY 16

#define PAUSE_MAX_MS 1e15

vm_t vm;

static unsigned poll_countdown = POLL_EVERY;

void vm_reset(void) {
    void (*on_clear)(void) = vm.on_clear;
    memset(&vm, 0, sizeof vm);
    vm.on_clear = on_clear;
    events_clear();
    trace_clear();
    on_clear();
    vm.default_type = VALUE_FLOAT;
}

unsigned vm_line(void) {
    return vm.statement != NULL ? code_u16(vm.statement + 1) : 0;
}

// The rare part of a statement's start.
static void attend(void) {
    poll_countdown = POLL_EVERY;
    console_send(); // or what was printed would wait for the end of a long computation
    console_poll();
    console_background(); // may print what came of it
    if (console_break_pending()) {
        errors_break();
    }
}

static void begin_statement(const uint8_t *statement) {
    vm.statement = statement;
    memory.scratch = vm.scratch_base;
    trace_statement(code_u16(statement + 1));
    bool input_came = hal_statement();
    if (input_came || --poll_countdown == 0) {
        attend();
    }
    if (vm.on_error == VM_ERROR_SKIP) {
        if (vm.skip_count == 0) {
            vm.on_error = VM_ERROR_ABORT;
        } else {
            vm.skip_count--;
        }
    }
}

static void push_word(value_t *value, const uint8_t *operands) {
    const value_t *slot = variables_slot(code_u16(operands));
    bool only_string = operands[2] != 0;
    bool usable = only_string ? slot->type == VALUE_STRING_REF
                              : slot->type != VALUE_NONE && slot->type != VALUE_ARRAY;
    if (usable) {
        *value = *slot;
        value_fetch(value);
        return;
    }
    value_set_text(value, (const char *)operands + 4, operands[3]);
    value->type = VALUE_WORD;
}

static void load_slowly(value_t *value, uint16_t variable) {
    value_t *slot = variables_slot(variable);
    if (slot->type == VALUE_NONE) {
        variables_create(variable);
    }
    *value = *slot;
    value->flags = 0;
    value_fetch(value);
}

// OP_FOR: fixes limit and step in the variable's type. True if the body is to run.
static bool for_begin(uint16_t variable, value_t *pair, value_t *limit_and_step) {
    value_t now;
    load_slowly(&now, variable);
    if (!value_is_numeric(&now)) {
        errors_fail(ERR_EXPECTED_NUMBER);
    }
    for (int i = 0; i < 2; i++) {
        if (now.type == VALUE_INTEGER) {
            value_set_integer(&pair[i], value_to_integer(&limit_and_step[i]));
        } else {
            value_set_number(&pair[i], value_to_number(&limit_and_step[i]));
        }
    }
    if (now.type == VALUE_INTEGER) {
        return pair[1].integer >= 0 ? now.integer <= pair[0].integer
                                    : now.integer >= pair[0].integer;
    }
    return pair[1].number >= 0 ? now.number <= pair[0].number : now.number >= pair[0].number;
}

// OP_NEXT for a variable that is not simply the routine's or the program's own. True: once more.
static bool for_next_slowly(uint16_t variable, const value_t *pair) {
    if (pair->type > VALUE_INTEGER) {
        errors_fail(ERR_NO_FOR);
    }
    value_t now;
    load_slowly(&now, variable);
    if (pair->type == VALUE_INTEGER) {
        int64_t before = value_to_integer(&now);
        int64_t step = pair[1].integer;
        int64_t after;
        if (__builtin_add_overflow(before, step, &after)) {
            return false;
        }
        value_set_integer(&now, after);
        variables_store(variable, &now);
        return step >= 0 ? after <= pair->integer : after >= pair->integer;
    }
    value_set_number(&now, value_to_number(&now) + pair[1].number);
    variables_store(variable, &now);
    return pair[1].number >= 0 ? now.number <= pair->number : now.number >= pair->number;
}

static inline bool for_next(uint16_t variable, const value_t *pair) {
    value_t *slot = variables_slot(variable);
    if (slot->type == pair->type && slot->flags == 0) {
        if (slot->type == VALUE_INTEGER && pair[1].integer == 1 && slot->integer < pair->integer) {
            slot->integer++;
            return true;
        }
        if (slot->type == VALUE_FLOAT) {
            slot->number += pair[1].number;
            int order = value_order(slot->number, pair->number);
            return signbit(pair[1].number) ? order >= 0 : order <= 0;
        }
    }
    return for_next_slowly(variable, pair);
}

static void keep(uint16_t variable, const value_t *value) {
    value_t *slot = variables_slot(variable);
    if (value->type == VALUE_STRING) {
        value_t *text = slot + 1;
        if (text->type != VALUE_STRING_REF) {
            variables_make_hidden_string(variable, text);
        }
        value_write(text, value);
        *slot = *text;
        return;
    }
    slot->type = value->type;
    slot->integer = value->integer;
}

static void load_constant(value_t *value, const uint8_t *bytes, value_type_t type) {
    memcpy(&value->integer, bytes, sizeof value->integer);
    value->type = (uint8_t)type;
    value->flags = 0;
}

// PAUSE: milliseconds become the time it ends.
static void compute_deadline(value_t *value) {
    double ms = value_to_number(value);
    if (!(ms >= 0 && ms < PAUSE_MAX_MS)) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    value_set_integer(value, (int64_t)(hal_time_us() + (uint64_t)(ms * 1000.0)));
}

// Waits until then, or until the SUB of an event has been entered: true.
static bool wait_is_interrupted(uint64_t until_us) {
    for (;;) {
        if (console_break_pending()) {
            errors_break();
        }
        if (hal_time_us() >= until_us) { // first: events that never cease must not hold it up
            return false;
        }
        if (events_watch != 0 && events_serve()) {
            return true;
        }
        console_wait(events_next_us(until_us));
    }
}

static inline bool both_integers(const value_t *left) {
    return left[0].type == VALUE_INTEGER && left[1].type == VALUE_INTEGER;
}

#define PUSHED() (sp < memory.values_limit ? sp++ : (errors_fail(ERR_TOO_COMPLEX), sp))

// Errors leave by a jump, so nothing here needs undoing: vm_run() starts the next statement afresh.
static void loop(void) {
    const uint8_t *pc = vm.pc;
    value_t *sp = vm.sp;
    for (;;) {
        code_op_t op = (code_op_t)*pc++;
        switch (op) {
        case OP_STATEMENT:
            if (vm.stop) {
                return;
            }
            begin_statement(pc - 1);
            sp = vm.operands;
            pc += 4;
            if (events_watch != 0) {
                vm.pc = pc;
                vm.sp = sp;
                if (events_serve()) {
                    pc = vm.pc;
                    sp = vm.sp;
                }
            }
            break;
        case OP_END:
            vm.at_end = !vm.stop;
            return;
        case OP_FAIL:
            err_raise(ERR_ARGUMENT, "%.*s", pc[0], (const char *)pc + 1);
            errors_fail_raised();
        case OP_INT16: {
            value_t *value = PUSHED();
            value_set_integer(value, (int16_t)code_u16(pc));
            value->flags = 0;
            pc += 2;
            break;
        }
        case OP_INTEGER:
            load_constant(PUSHED(), pc, VALUE_INTEGER);
            pc += 8;
            break;
        case OP_FLOAT:
            load_constant(PUSHED(), pc, VALUE_FLOAT);
            pc += 8;
            break;
        case OP_STRING:
            value_set_text(PUSHED(), (const char *)pc + 1, pc[0]);
            pc += 1 + pc[0];
            break;
        case OP_BLANK:
            PUSHED()->type = VALUE_NONE;
            break;
        case OP_WORD:
            push_word(PUSHED(), pc);
            pc += 4 + pc[3];
            break;
        case OP_LITERAL:
            sp[-1].flags = VALUE_LITERAL;
            break;
        case OP_LOAD: {
            const value_t *slot = variables_slot(code_u16(pc));
            value_t *value = PUSHED();
            if (slot->type <= VALUE_INTEGER) {
                value->integer = slot->integer;
                value->type = slot->type;
                value->flags = 0;
            } else {
                load_slowly(value, code_u16(pc));
            }
            pc += 2;
            break;
        }
        case OP_LOAD_ELEMENT:
        case OP_REF_ELEMENT:
            sp -= pc[2];
            variables_element(code_u16(pc), sp, pc[2], sp);
            if (op == OP_LOAD_ELEMENT) {
                value_fetch(sp);
            }
            sp++;
            pc += 3;
            break;
        case OP_STORE: {
            value_t *slot = variables_slot(code_u16(pc));
            sp--;
            if (slot->type == sp->type && slot->type <= VALUE_INTEGER && slot->flags == 0) {
                slot->integer = sp->integer;
            } else {
                variables_store(code_u16(pc), sp);
            }
            pc += 2;
            break;
        }
        case OP_STORE_ELEMENT: {
            value_t element;
            sp -= pc[2] + 1;
            variables_element(code_u16(pc), sp, pc[2], &element);
            value_write(&element, sp + pc[2]);
            pc += 3;
            break;
        }
        case OP_KEEP:
            keep(code_u16(pc), --sp);
            pc += 2;
            break;
        case OP_REF:
        case OP_REF_ARRAY:
            variables_reference(code_u16(pc), op == OP_REF_ARRAY, PUSHED());
            pc += 2;
            break;
        case OP_KNOWN: {
            value_t *value = PUSHED();
            value_set_integer(value, variables_slot(code_u16(pc))->type != VALUE_NONE);
            pc += 2;
            break;
        }
        case OP_CHECK_TYPE:
            variables_check_type(code_u16(pc), pc[2]);
            pc += 3;
            break;
        case OP_ADD:
            sp--;
            if (both_integers(sp - 1)) {
                sp[-1].integer = (int64_t)((uint64_t)sp[-1].integer + (uint64_t)sp[0].integer);
            } else {
                arith_binary(op, sp - 1);
            }
            break;
        case OP_SUBTRACT:
            sp--;
            if (both_integers(sp - 1)) {
                sp[-1].integer = (int64_t)((uint64_t)sp[-1].integer - (uint64_t)sp[0].integer);
            } else {
                arith_binary(op, sp - 1);
            }
            break;
        case OP_MULTIPLY ... OP_XOR:
            sp--;
            arith_binary(op, sp - 1);
            break;
        case OP_NEGATE ... OP_PLUS:
            arith_unary(op, sp - 1);
            break;
        case OP_JUMP:
            pc = memory.base + code_u24(pc);
            break;
        case OP_JUMP_FALSE:
        case OP_JUMP_TRUE:
            sp--;
            pc = value_is_true(sp) == (op == OP_JUMP_TRUE) ? memory.base + code_u24(pc) : pc + 3;
            break;
        case OP_GOSUB:
            calls_gosub(pc + 3);
            pc = memory.base + code_u24(pc);
            break;
        case OP_RETURN:
            pc = calls_return();
            break;
        case OP_FOR:
            sp -= 2;
            if (for_begin(code_u16(pc), variables_slot(code_u16(pc + 2)), sp)) {
                pc += 7;
            } else {
                pc = memory.base + code_u24(pc + 4);
            }
            break;
        case OP_NEXT:
            if (for_next(code_u16(pc), variables_slot(code_u16(pc + 2)))) {
                pc = memory.base + code_u24(pc + 4);
            } else {
                pc += 7;
            }
            break;
        case OP_CALL:
            vm.pc = pc + 3;
            vm.sp = sp;
            calls_enter(((const symbols_t *)memory_place(code_u16(pc)))->routine, pc[2]);
            pc = vm.pc;
            sp = vm.sp;
            break;
        case OP_INDIRECT:
            vm.pc = pc + 2;
            vm.sp = sp;
            indirect_run((indirect_kind_t)pc[0], pc[1]);
            pc = vm.pc;
            sp = vm.sp;
            break;
        case OP_LEAVE:
            calls_leave();
            pc = vm.pc;
            sp = vm.sp;
            break;
        case OP_FUNCTION:
            sp -= pc[1];
            vm.sp = sp + pc[1];
            if (sp >= memory.values_limit) {
                errors_fail(ERR_TOO_COMPLEX);
            }
            functions_evaluate(pc[0], sp, pc[1]);
            sp++;
            pc += 2;
            break;
        case OP_HOST_FUNCTION:
            sp -= pc[2];
            if (sp >= memory.values_limit) {
                errors_fail(ERR_TOO_COMPLEX);
            }
            args_evaluate(pc, sp, pc[2]);
            sp++;
            pc += 3;
            break;
        case OP_COMMAND:
            sp -= pc[2];
            args_run(pc, sp, pc[2]);
            pc += 3;
            break;
        case OP_ASSIGNMENT:
            sp -= pc[2];
            args_assign(pc, sp, pc[2]);
            pc += 3;
            break;
        case OP_ACTION:
            sp -= pc[1];
            vm.pc = pc + 2;
            actions_table[pc[0]](sp, pc[1]);
            pc = vm.pc;
            break;
        case OP_DEADLINE:
            compute_deadline(sp - 1);
            break;
        case OP_WAIT:
            vm.pc = pc - 1; // once more behind the SUB of an event
            vm.sp = sp;
            if (wait_is_interrupted((uint64_t)sp[-1].integer)) {
                pc = vm.pc;
                sp = vm.sp;
            } else {
                sp--;
            }
            break;
        case OP_DATA:
            pc += 4 + pc[3];
            break;
        }
    }
}

// True if ON ERROR lets the program go on; then it does so behind the statement that failed.
static bool goes_on_after_error(void) {
    vm.error_code = err_code();
    format_text(vm.error_text, sizeof vm.error_text, "%s", err_message());
    if (vm.on_error == VM_ERROR_ABORT) {
        return false;
    }
    indirect_unwind();
    vm.pc = vm.statement + code_u16(vm.statement + 3);
    return true;
}

err_t vm_run(const uint8_t *code, bool *broken) {
    vm.pc = code;
    vm.statement = code;
    vm.depth = 0;
    vm.interrupt_depth = 0;
    vm.locals = vm.operands = memory.values;
    vm.scratch_base = memory.scratch;
    vm.stop = false;
    vm.at_end = false;
    vm.request = VM_REQUEST_NONE;
    *broken = false;
    for (;;) {
        vm.sp = vm.operands;
        errors_outcome_t outcome = errors_try(loop);
        if (outcome == ERRORS_BREAK) {
            *broken = true;
            return ERR_OK;
        }
        if (outcome == ERRORS_NONE) {
            return ERR_OK;
        }
        console_poll(); // no chain of errors may hide Ctrl-C
        if (console_break_pending()) {
            *broken = true;
            return ERR_OK;
        }
        if (!goes_on_after_error()) {
            return ERR_ARGUMENT;
        }
    }
}
