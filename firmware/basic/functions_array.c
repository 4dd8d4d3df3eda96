// MATH(SUM array()) and its kin: one number from many. Context: main loop.
#include <math.h>
#include <string.h>

#include "arith.h"
#include "errors.h"
#include "functions.h"
#include "memory.h"
#include "sort.h"
#include "variables.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)

static const variables_array_t *numeric_array(const value_t *argument) {
    if (argument->type != VALUE_ARRAY) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    const variables_array_t *array = argument->data;
    if (array->type == VALUE_STRING) {
        errors_fail(ERR_EXPECTED_NUMBER);
    }
    return array;
}

static value_t nth(const variables_array_t *array, uint32_t index) {
    value_t element;
    variables_nth(array, index, &element);
    value_fetch(&element);
    return element;
}

// In the array's own type: integers wrap as they do with +.
FUNCTION(math_sum) {
    (void)count;
    const variables_array_t *array = numeric_array(arguments);
    value_t pair[2] = {nth(array, 0)};
    for (uint32_t i = 1; i < array->count; i++) {
        pair[1] = nth(array, i);
        arith_binary(OP_ADD, pair);
    }
    *result = pair[0];
}

static double mean_of(const variables_array_t *array) {
    double sum = 0;
    for (uint32_t i = 0; i < array->count; i++) {
        value_t element = nth(array, i);
        sum += value_to_number(&element);
    }
    return sum / array->count;
}

static void set_checked(value_t *result, double number) {
    if (!value_is_finite(number)) {
        errors_fail(ERR_OVERFLOW);
    }
    value_set_number(result, number);
}

FUNCTION(math_mean) {
    (void)count;
    set_checked(result, mean_of(numeric_array(arguments)));
}

// Of the elements as the whole population.
FUNCTION(math_sd) {
    (void)count;
    const variables_array_t *array = numeric_array(arguments);
    double mean = mean_of(array);
    double squares = 0;
    for (uint32_t i = 0; i < array->count; i++) {
        value_t element = nth(array, i);
        double difference = value_to_number(&element) - mean;
        squares += difference * difference;
    }
    set_checked(result, sqrt(squares / array->count));
}

// The largest (sign 1) or smallest (-1) element; a second argument gets its subscript.
static void find_extreme(value_t *arguments, unsigned count, value_t *result, int sign) {
    const variables_array_t *array = numeric_array(arguments);
    uint32_t best_index = 0;
    value_t best = nth(array, 0);
    for (uint32_t i = 1; i < array->count; i++) {
        value_t pair[2] = {nth(array, i), best};
        arith_binary(sign > 0 ? OP_GREATER : OP_LESS, pair);
        if (pair[0].integer != 0) {
            best = nth(array, i);
            best_index = i;
        }
    }
    if (count > 1) {
        value_t subscript;
        value_set_integer(&subscript, (int64_t)best_index + array->base);
        value_write(&arguments[1], &subscript);
    }
    *result = best;
}

FUNCTION(math_max) {
    find_extreme(arguments, count, result, 1);
}

FUNCTION(math_min) {
    find_extreme(arguments, count, result, -1);
}

// A copy is sorted; of an even number of elements the mean of the middle two.
FUNCTION(math_median) {
    (void)count;
    const variables_array_t *array = numeric_array(arguments);
    variables_array_t copy = *array;
    copy.elements = memory_scratch(variables_size(array));
    memcpy(copy.elements, array->elements, variables_size(array));
    sort_run(&(const sort_t){.array = &copy, .count = copy.count});
    value_t low = nth(&copy, (copy.count - 1) / 2);
    value_t high = nth(&copy, copy.count / 2);
    set_checked(result, value_to_number(&low) / 2 + value_to_number(&high) / 2);
}
