// Arguments that stand for several numbers: data to be sent, and variables to be written into. The
// values stay on the stack while the handler runs. Context: main loop.
#include "args_data.h"

#include "errors.h"
#include "variables.h"

#define BEYOND 9.2e18 // about where 64 bits end

static const value_t *value_at(const basic_arg_t *arg, size_t index) {
    return (const value_t *)arg->data.values + index;
}

static bool is_array(const value_t *value) {
    return value->type == VALUE_ARRAY;
}

static _Noreturn void fail_expected(const basic_arg_spec_t *spec, const char *what) {
    errors_fail_with(ERR_ARGUMENT, "%s: expected %s", spec->name, what);
}

static void check_array(const basic_arg_spec_t *spec, const variables_array_t *array) {
    if (array->type == VALUE_STRING) {
        fail_expected(spec, "an array of numbers");
    }
}

// ---- Data ---------------------------------------------------------------------------------------

static int64_t count_single(const basic_arg_spec_t *spec, const value_t *value) {
    if (is_array(value)) {
        const variables_array_t *array = value->data;
        check_array(spec, array);
        return array->count;
    }
    value_t fetched = *value;
    value_fetch(&fetched);
    return fetched.type == VALUE_STRING ? (int64_t)fetched.length : 1;
}

static void check_number(const basic_arg_spec_t *spec, const value_t *value) {
    if (value->type == VALUE_NONE) {
        errors_fail_with(ERR_ARGUMENTS_MISSING, "%s", spec->name);
    }
    value_t fetched = *value;
    if (!is_array(value)) {
        value_fetch(&fetched);
    }
    if (!value_is_numeric(&fetched)) {
        fail_expected(spec, "numbers, one string or one array");
    }
}

void args_data_deliver(const basic_arg_spec_t *spec, const value_t *values, unsigned count,
                       basic_arg_t *arg) {
    *arg = (basic_arg_t){.given = true, .integer = count, .data = {values, count}};
    if (count == 1 && values[0].type != VALUE_NONE) {
        arg->integer = count_single(spec, &values[0]);
        return;
    }
    for (unsigned i = 0; i < count; i++) {
        check_number(spec, &values[i]);
    }
}

static int64_t nearest(double number) {
    if (number > BEYOND) {
        return INT64_MAX;
    }
    return number > -BEYOND ? value_round(number) : INT64_MIN; // so is what is no number
}

int64_t basic_data_number(const basic_arg_t *arg, size_t index) {
    value_t value = *value_at(arg, arg->data.count > 1 ? index : 0);
    if (is_array(&value)) {
        variables_nth(value.data, (uint32_t)index, &value);
    }
    value_fetch(&value);
    if (value.type == VALUE_STRING) {
        return (unsigned char)value.text[index];
    }
    return value.type == VALUE_INTEGER ? value.integer : nearest(value.number);
}

// ---- A variable to write into -------------------------------------------------------------------

void args_data_deliver_store(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg) {
    *arg = (basic_arg_t){.given = true, .integer = 1, .data = {value, 1}};
    switch (value->type) {
    case VALUE_ARRAY:
        check_array(spec, value->data);
        arg->integer = ((const variables_array_t *)value->data)->count;
        break;
    case VALUE_STRING_REF:
        arg->integer = value->capacity;
        break;
    case VALUE_FLOAT_REF:
    case VALUE_INTEGER_REF:
        break;
    default:
        errors_fail(ERR_CONSTANT);
    }
}

void basic_store_number(const basic_arg_t *arg, size_t index, int64_t number) {
    value_t place = *value_at(arg, 0);
    if (place.type == VALUE_STRING_REF) {
        uint8_t *bytes = place.data;
        bytes[1 + index] = (uint8_t)number;
        bytes[0] = (uint8_t)(index + 1);
        return;
    }
    if (is_array(&place)) {
        variables_nth(place.data, (uint32_t)index, &place);
    }
    value_t value = {.type = VALUE_INTEGER, .integer = number};
    value_write(&place, &value);
}
