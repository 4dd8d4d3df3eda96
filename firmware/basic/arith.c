// The operators of expressions, by the types of their operands. Context: main loop.
#include "arith.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "errors.h"
#include "memory.h"

// int64_t arithmetic that wraps instead of being undefined.
static int64_t wrapped(uint64_t value) {
    return (int64_t)value;
}

static bool fits_multiply(int64_t left, int64_t right, int64_t *product) {
    return !__builtin_mul_overflow(left, right, product);
}

static void set_checked(value_t *value, double number) {
    if (!value_is_finite(number)) {
        errors_fail(ERR_OVERFLOW);
    }
    value_set_number(value, number);
}

static int64_t divide_integers(int64_t left, int64_t right, bool remainder) {
    if (right == 0) {
        errors_fail(ERR_DIVIDE_BY_ZERO);
    }
    if (right == -1) { // the most negative number has no positive counterpart
        return remainder ? 0 : wrapped(0 - (uint64_t)left);
    }
    return remainder ? left % right : left / right;
}

// An integer power stays an integer as long as it fits.
static void power(value_t *values) {
    if (values[0].type == VALUE_INTEGER && values[1].type == VALUE_INTEGER &&
        values[1].integer >= 0) {
        int64_t result = 1;
        int64_t base = values[0].integer;
        uint64_t exponent = (uint64_t)values[1].integer;
        bool fits = true;
        while (exponent != 0 && fits) {
            if (exponent & 1) {
                fits = fits_multiply(result, base, &result);
            }
            exponent >>= 1;
            if (exponent != 0 && fits) {
                fits = fits_multiply(base, base, &base);
            }
        }
        if (fits) {
            values[0].integer = result;
            return;
        }
    }
    double base = value_to_number(&values[0]);
    double exponent = value_to_number(&values[1]);
    if (base == 0.0 && exponent < 0.0) {
        errors_fail(ERR_DIVIDE_BY_ZERO);
    }
    set_checked(&values[0], pow(base, exponent));
}

static int64_t shift(code_op_t op, int64_t value, int64_t count) {
    if (count < 0 || count > 63) {
        return 0;
    }
    return op == OP_SHIFT_LEFT ? wrapped((uint64_t)value << count)
                               : wrapped((uint64_t)value >> count);
}

// Operators that always work on integers.
static void integer_operator(code_op_t op, value_t *values) {
    int64_t left = value_to_integer(&values[0]);
    int64_t right = value_to_integer(&values[1]);
    int64_t result;
    switch (op) {
    case OP_INT_DIVIDE:
        result = divide_integers(left, right, false);
        break;
    case OP_MOD:
        result = divide_integers(left, right, true);
        break;
    case OP_AND:
        result = left & right;
        break;
    case OP_OR:
        result = left | right;
        break;
    case OP_XOR:
        result = left ^ right;
        break;
    default:
        result = shift(op, left, right);
        break;
    }
    value_set_integer(values, result);
}

static bool order_matches(code_op_t op, int order) {
    switch (op) {
    case OP_NOT_EQUAL:
        return order != 0;
    case OP_LESS:
        return order < 0;
    case OP_GREATER:
        return order > 0;
    case OP_LESS_EQUAL:
        return order <= 0;
    case OP_GREATER_EQUAL:
        return order >= 0;
    default:
        return order == 0;
    }
}

static bool is_comparison(code_op_t op) {
    return op >= OP_NOT_EQUAL && op <= OP_EQUAL;
}

static void compare_numbers(code_op_t op, value_t *values) {
    int order;
    if (values[0].type == VALUE_INTEGER && values[1].type == VALUE_INTEGER) {
        order = (values[0].integer > values[1].integer) - (values[0].integer < values[1].integer);
    } else {
        order = value_order(value_to_number(&values[0]), value_to_number(&values[1]));
    }
    value_set_integer(values, order_matches(op, order));
}

static void text_operator(code_op_t op, value_t *values) {
    if (is_comparison(op)) {
        value_set_integer(values, order_matches(op, value_compare_text(&values[0], &values[1])));
        return;
    }
    if (op != OP_ADD) {
        errors_fail(ERR_INVALID_OPERATOR);
    }
    size_t length = values[0].length + values[1].length;
    if (length > VALUE_STRING_MAX) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    char *text = memory_text(length);
    memcpy(text, values[0].text, values[0].length);
    memcpy(text + values[0].length, values[1].text, values[1].length);
    value_set_text(values, text, length);
}

static void wrapping_operator(code_op_t op, value_t *values) {
    uint64_t left = (uint64_t)values[0].integer;
    uint64_t right = (uint64_t)values[1].integer;
    values[0].integer = wrapped(op == OP_MULTIPLY ? left * right
                                : op == OP_ADD    ? left + right
                                                  : left - right);
}

// + - * / : integers stay integers, except with /.
static void basic_operator(code_op_t op, value_t *values) {
    if (op != OP_DIVIDE && values[0].type == VALUE_INTEGER && values[1].type == VALUE_INTEGER) {
        wrapping_operator(op, values);
        return;
    }
    double left = value_to_number(&values[0]);
    double right = value_to_number(&values[1]);
    switch (op) {
    case OP_ADD:
        set_checked(values, left + right);
        break;
    case OP_SUBTRACT:
        set_checked(values, left - right);
        break;
    case OP_MULTIPLY:
        set_checked(values, left * right);
        break;
    default:
        if (value_is_zero(right)) {
            errors_fail(ERR_DIVIDE_BY_ZERO);
        }
        set_checked(values, left / right);
        break;
    }
}

void arith_binary(code_op_t op, value_t *values) {
    values[0].flags = 0;
    bool left_is_text = values[0].type == VALUE_STRING;
    bool right_is_text = values[1].type == VALUE_STRING;
    if (left_is_text && right_is_text) {
        text_operator(op, values);
    } else if (left_is_text || right_is_text) {
        errors_fail(ERR_INCOMPATIBLE_TYPES);
    } else if (is_comparison(op)) {
        compare_numbers(op, values);
    } else if (op == OP_POWER) {
        power(values);
    } else if (op <= OP_DIVIDE) {
        basic_operator(op, values);
    } else {
        integer_operator(op, values);
    }
}

void arith_unary(code_op_t op, value_t *value) {
    value->flags = 0;
    if (!value_is_numeric(value)) {
        errors_fail(ERR_EXPECTED_NUMBER);
    }
    switch (op) {
    case OP_NEGATE:
        if (value->type == VALUE_INTEGER) {
            value->integer = wrapped(0 - (uint64_t)value->integer);
        } else {
            value->number = -value->number;
        }
        break;
    case OP_NOT:
        value_set_integer(value, !value_is_true(value));
        break;
    case OP_INVERT:
        value_set_integer(value, ~value_to_integer(value));
        break;
    default:
        break;
    }
}
