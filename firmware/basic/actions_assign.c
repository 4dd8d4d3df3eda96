// Assignments to parts of variables: MID$, BYTE and BIT. Context: main loop.
#include <string.h>

#include "actions.h"
#include "errors.h"
#include "memory.h"

static unsigned in_range(const value_t *argument, int64_t least, int64_t most) {
    int64_t value = value_to_integer(argument);
    if (value < least || value > most) {
        errors_fail_with(ERR_ARGUMENT, "%lld is invalid (valid is %d to %d)", (long long)value,
                         (int)least, (int)most);
    }
    return (unsigned)value;
}

static uint8_t *bytes_of(const value_t *reference) {
    if (reference->type != VALUE_STRING_REF) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    return reference->data;
}

// variable, position, byte
void actions_set_byte(value_t *arguments, unsigned count) {
    (void)count;
    uint8_t *bytes = bytes_of(&arguments[0]);
    unsigned place = in_range(&arguments[1], 1, bytes[0]);
    bytes[place] = (uint8_t)in_range(&arguments[2], 0, UINT8_MAX);
}

// variable, number of the bit, 0 or 1
void actions_set_bit(value_t *arguments, unsigned count) {
    (void)count;
    if (arguments[0].type != VALUE_INTEGER_REF) {
        errors_fail_with(ERR_INCOMPATIBLE_TYPE, "argument 1");
    }
    int64_t *integer = arguments[0].data;
    uint64_t mask = (uint64_t)1 << in_range(&arguments[1], 0, 63);
    unsigned bit = in_range(&arguments[2], 0, 1);
    *integer = (int64_t)(bit != 0 ? (uint64_t)*integer | mask : (uint64_t)*integer & ~mask);
}

// variable, start [, count], text: that many characters make room for the text
void actions_set_mid(value_t *arguments, unsigned count) {
    const uint8_t *bytes = bytes_of(&arguments[0]);
    const value_t *text = &arguments[count - 1];
    if (text->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    unsigned length = bytes[0];
    unsigned before = in_range(&arguments[1], 1, length) - 1;
    unsigned replaced = count > 3 ? in_range(&arguments[2], 0, VALUE_STRING_MAX) : text->length;
    unsigned behind = before + replaced < length ? before + replaced : length;
    unsigned whole = before + text->length + (length - behind);
    if (whole > VALUE_STRING_MAX) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    char *made = memory_text(whole);
    memcpy(made, bytes + 1, before);
    memcpy(made + before, text->text, text->length);
    memcpy(made + before + text->length, bytes + 1 + behind, length - behind);
    value_t value;
    value_set_text(&value, made, whole);
    value_write(&arguments[0], &value);
}
