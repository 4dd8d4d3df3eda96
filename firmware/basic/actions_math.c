// SORT and MATH at run time. Context: main loop.
#include <string.h>

#include "actions.h"
#include "arith.h"
#include "errors.h"
#include "sort.h"
#include "variables.h"

enum { SORT_DESCENDING = 1, SORT_IGNORE_CASE = 2, SORT_EMPTY_LAST = 4, SORT_FLAGS = 7 };

static variables_array_t *array_of(const value_t *argument) {
    if (argument->type != VALUE_ARRAY) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    return argument->data;
}

static variables_array_t *numeric_array(const value_t *argument) {
    variables_array_t *array = array_of(argument);
    if (array->type == VALUE_STRING) {
        errors_fail(ERR_EXPECTED_NUMBER);
    }
    return array;
}

// ---- SORT ---------------------------------------------------------------------------------------

// A left out argument is VALUE_NONE.
static int64_t integer_or(const value_t *argument, int64_t otherwise) {
    return argument->type == VALUE_NONE ? otherwise : value_to_integer(argument);
}

static int64_t in_range(int64_t value, int64_t least, int64_t most, const char *name) {
    if (value < least || value > most) {
        errors_fail_with(ERR_ARGUMENT, "%s: %lld is invalid (valid is %lld to %lld)", name,
                         (long long)value, (long long)least, (long long)most);
    }
    return value;
}

// The subscripts the elements have before they are sorted.
static void number_elements(const variables_array_t *index) {
    for (uint32_t i = 0; i < index->count; i++) {
        value_t element, subscript;
        variables_nth(index, i, &element);
        value_set_integer(&subscript, (int64_t)i + index->base);
        value_write(&element, &subscript);
    }
}

static const variables_array_t *index_array(const value_t *argument, const variables_array_t *of) {
    if (argument->type == VALUE_NONE) {
        return NULL;
    }
    const variables_array_t *index = array_of(argument);
    if (index->type != VALUE_INTEGER || index == of) {
        errors_fail_with(ERR_INCOMPATIBLE_TYPE, "argument 2");
    }
    if (index->dimensions != 1 || index->count != of->count || index->base != of->base) {
        errors_fail(ERR_ARRAY_SIZE);
    }
    return index;
}

// array, index array, flags, first subscript, count; all but the first may be left out
void actions_sort(value_t *arguments, unsigned count) {
    (void)count;
    const variables_array_t *array = array_of(&arguments[0]);
    if (array->dimensions != 1) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    int64_t base = array->base;
    int64_t flags = in_range(integer_or(&arguments[2], 0), 0, SORT_FLAGS, "flags");
    int64_t first =
        in_range(integer_or(&arguments[3], base), base, base + array->count - 1, "start");
    int64_t rest = array->count - (first - base);
    int64_t wanted = in_range(integer_or(&arguments[4], rest), 1, rest, "count");
    const sort_t job = {
        .array = array,
        .index = index_array(&arguments[1], array),
        .first = (uint32_t)(first - base),
        .count = (uint32_t)wanted,
        .descending = (flags & SORT_DESCENDING) != 0,
        .ignore_case = (flags & SORT_IGNORE_CASE) != 0,
        .empty_last = (flags & SORT_EMPTY_LAST) != 0,
    };
    if (job.index != NULL) {
        number_elements(job.index);
    }
    sort_run(&job);
}

// ---- MATH ---------------------------------------------------------------------------------------

// value, array
void actions_math_set(value_t *arguments, unsigned count) {
    (void)count;
    const variables_array_t *array = numeric_array(&arguments[1]);
    for (uint32_t i = 0; i < array->count; i++) {
        value_t element;
        variables_nth(array, i, &element);
        value_write(&element, &arguments[0]);
    }
}

static void check_same_size(const variables_array_t *one, const variables_array_t *other) {
    if (one->count != other->count) {
        errors_fail(ERR_ARRAY_SIZE);
    }
}

// target(i) = source(i) op operand. All are computed before the first is written: an error changes
// nothing.
static void each(code_op_t op, const value_t *source, const value_t *operand,
                 const value_t *target) {
    const variables_array_t *from = numeric_array(source);
    const variables_array_t *to = numeric_array(target);
    check_same_size(from, to);
    for (int writing = 0; writing < 2; writing++) {
        for (uint32_t i = 0; i < from->count; i++) {
            value_t pair[2], element;
            variables_nth(from, i, &pair[0]);
            value_fetch(&pair[0]);
            pair[1] = *operand;
            arith_binary(op, pair);
            variables_nth(to, i, &element);
            if (writing) {
                value_write(&element, &pair[0]);
            } else if (to->type == VALUE_INTEGER) {
                value_to_integer(&pair[0]);
            }
        }
    }
}

// array, number, target
void actions_math_scale(value_t *arguments, unsigned count) {
    (void)count;
    each(OP_MULTIPLY, &arguments[0], &arguments[1], &arguments[2]);
}

void actions_math_add(value_t *arguments, unsigned count) {
    (void)count;
    each(OP_ADD, &arguments[0], &arguments[1], &arguments[2]);
}

static double nth_number(const variables_array_t *array, uint32_t index) {
    value_t element;
    variables_nth(array, index, &element);
    value_fetch(&element);
    return value_to_number(&element);
}

// array, array, ratio, target: target(i) = a(i) + (b(i) - a(i)) * ratio
void actions_math_interpolate(value_t *arguments, unsigned count) {
    (void)count;
    const variables_array_t *from = numeric_array(&arguments[0]);
    const variables_array_t *towards = numeric_array(&arguments[1]);
    const variables_array_t *to = numeric_array(&arguments[3]);
    double ratio = value_to_number(&arguments[2]);
    check_same_size(from, towards);
    check_same_size(from, to);
    for (uint32_t i = 0; i < from->count; i++) {
        value_t element, value;
        double start = nth_number(from, i);
        value_set_number(&value, start + (nth_number(towards, i) - start) * ratio);
        variables_nth(to, i, &element);
        value_write(&element, &value);
    }
}
