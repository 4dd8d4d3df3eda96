// Conversions between the types of values. Context: main loop.
#include "value.h"

#include <math.h>
#include <string.h>

#include "errors.h"

#define INTEGER_LIMIT 9223372036854775808.0 // 2^63

void value_fetch(value_t *value) {
    switch (value->type) {
    case VALUE_FLOAT_REF:
        value_set_number(value, *(const double *)value->data);
        break;
    case VALUE_INTEGER_REF:
        value_set_integer(value, *(const int64_t *)value->data);
        break;
    case VALUE_STRING_REF: {
        const uint8_t *bytes = value->data;
        value_set_text(value, (const char *)bytes + 1, bytes[0]);
        break;
    }
    case VALUE_ARRAY:
        errors_fail(ERR_ARRAY_DIMENSIONS);
    default:
        break;
    }
}

void value_write(const value_t *reference, const value_t *value) {
    switch (reference->type) {
    case VALUE_FLOAT_REF:
        *(double *)reference->data = value_to_number(value);
        break;
    case VALUE_INTEGER_REF:
        *(int64_t *)reference->data = value_to_integer(value);
        break;
    case VALUE_STRING_REF: {
        if (value->type != VALUE_STRING) {
            errors_fail(ERR_EXPECTED_STRING);
        }
        if (value->length > reference->capacity) {
            errors_fail(ERR_STRING_TOO_LONG);
        }
        uint8_t *bytes = reference->data;
        memmove(bytes + 1, value->text, value->length);
        bytes[0] = (uint8_t)value->length;
        break;
    }
    case VALUE_ARRAY:
        errors_fail(ERR_ARRAY_DIMENSIONS);
    default:
        errors_fail(ERR_CONSTANT);
    }
}

double value_to_number(const value_t *value) {
    if (value->type == VALUE_FLOAT) {
        return value->number;
    }
    if (value->type == VALUE_INTEGER) {
        int32_t small = (int32_t)value->integer;
        return small == value->integer ? (double)small
                                       : (double)value->integer; // 32 bits are quicker
    }
    errors_fail(ERR_EXPECTED_NUMBER);
}

int64_t value_round(double number) {
    double rounded = round(number); // half away from zero
    if (!(rounded >= -INTEGER_LIMIT && rounded < INTEGER_LIMIT)) {
        errors_fail(ERR_NUMBER_TOO_LARGE);
    }
    return (int64_t)rounded;
}

int64_t value_to_integer(const value_t *value) {
    if (value->type == VALUE_INTEGER) {
        return value->integer;
    }
    return value_round(value_to_number(value));
}

bool value_is_true(const value_t *value) {
    return value->type == VALUE_INTEGER ? value->integer != 0
                                        : !value_is_zero(value_to_number(value));
}

int value_compare_text(const value_t *left, const value_t *right) {
    size_t shared = left->length < right->length ? left->length : right->length;
    int order = memcmp(left->text, right->text, shared);
    if (order != 0) {
        return order;
    }
    return (left->length > right->length) - (left->length < right->length);
}

void value_set_text(value_t *value, const char *text, size_t length) {
    value->text = text;
    value->length = (uint32_t)length;
    value->type = VALUE_STRING;
}
