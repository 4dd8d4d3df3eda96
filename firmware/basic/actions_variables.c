// DIM, REDIM, ERASE, CONST, INC and CAT at run time. Context: main loop.
#include "actions.h"
#include "arith.h"
#include "arrays.h"
#include "errors.h"
#include "variables.h"

// sizes ..., type, length, variable
void actions_dim(value_t *arguments, unsigned count) {
    unsigned dimensions = count - 3;
    uint8_t type = (uint8_t)arguments[dimensions].integer;
    int64_t length = value_to_integer(&arguments[dimensions + 1]);
    if (length < 1 || length > VALUE_STRING_MAX) {
        errors_fail(ERR_ARRAY_SIZE);
    }
    uint16_t variable = (uint16_t)arguments[dimensions + 2].integer;
    variables_declare(variable, type, (unsigned)length, arguments, dimensions);
}

// sizes ..., type or VALUE_NONE, length or 0, variable, preserve
void actions_redim(value_t *arguments, unsigned count) {
    unsigned dimensions = count - 4;
    const value_t *rest = arguments + dimensions;
    int64_t length = value_to_integer(&rest[1]);
    if (length < 0 || length > VALUE_STRING_MAX) {
        errors_fail(ERR_ARRAY_SIZE);
    }
    arrays_redim((uint16_t)rest[2].integer, (uint8_t)rest[0].integer, (unsigned)length, arguments,
                 dimensions, value_is_true(&rest[3]));
}

void actions_erase(value_t *arguments, unsigned count) {
    (void)count;
    arrays_erase((uint16_t)arguments->integer);
}

void actions_clear(value_t *arguments, unsigned count) {
    (void)arguments;
    (void)count;
    arrays_erase_all();
}

// variable, index, value
void actions_fill(value_t *arguments, unsigned count) {
    (void)count;
    value_t element;
    const variables_array_t *array = variables_array((uint16_t)arguments[0].integer);
    if (arguments[1].integer >= array->count) {
        errors_fail(ERR_ARRAY_SIZE);
    }
    variables_nth(array, (uint32_t)arguments[1].integer, &element);
    value_write(&element, &arguments[2]);
}

// value, type or VALUE_NONE, variable
void actions_const(value_t *arguments, unsigned count) {
    (void)count;
    uint16_t variable = (uint16_t)arguments[2].integer;
    value_t *slot = variables_slot(variable);
    if (slot->type != VALUE_NONE) {
        errors_fail_with(ERR_GLOBAL_DECLARED, "%s", variables_name(variable));
    }
    uint8_t type = (uint8_t)arguments[1].integer;
    if (type == VALUE_NONE) {
        type = arguments[0].type;
    }
    if ((type == VALUE_STRING) != (arguments[0].type == VALUE_STRING)) {
        errors_fail(type == VALUE_STRING ? ERR_EXPECTED_STRING : ERR_EXPECTED_NUMBER);
    }
    unsigned capacity = type == VALUE_STRING && arguments[0].length > 0 ? arguments[0].length : 1;
    variables_declare(variable, type, capacity, NULL, 0);
    variables_store(variable, &arguments[0]);
    slot->flags |= VALUE_CONSTANT;
}

// reference, amount
void actions_inc(value_t *arguments, unsigned count) {
    (void)count;
    value_t sum[2] = {arguments[0], arguments[1]};
    value_fetch(&sum[0]);
    arith_binary(OP_ADD, sum);
    value_write(&arguments[0], &sum[0]);
}

// reference, text
void actions_cat(value_t *arguments, unsigned count) {
    if (arguments[0].type != VALUE_STRING_REF) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    actions_inc(arguments, count);
}
