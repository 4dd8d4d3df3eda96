// Numbers as text and text as numbers. Context: main loop.
#include "number_text.h"

#include <math.h>

#include "base/base.h"

#define PRINT_DIGITS 10
#define PRINT_FIXED_BELOW 1000000.0
#define PRINT_FIXED_FROM 0.0001

size_t number_text_float(char *buffer, double number) {
    double magnitude = fabs(number);
    bool plain =
        magnitude == 0.0 || (magnitude < PRINT_FIXED_BELOW && magnitude >= PRINT_FIXED_FROM);
    return plain ? num_text_general(buffer, number, PRINT_DIGITS)
                 : num_text_short_exponent(buffer, number, PRINT_DIGITS);
}

size_t number_text_value(char *buffer, const value_t *value) {
    return value->type == VALUE_INTEGER ? num_text_integer(buffer, value->integer)
                                        : number_text_float(buffer, value_to_number(value));
}

static unsigned digit_value(char c) {
    if (c >= '0' && c <= '9') {
        return (unsigned)(c - '0');
    }
    c = (char)(c | 0x20);
    return c >= 'a' && c <= 'f' ? (unsigned)(c - 'a') + 10 : 99;
}

// The base of a numeral like &H or 0x at `p`, or 0.
static unsigned base_of_prefix(const char *p, const char *end) {
    if (end - p < 2) {
        return 0;
    }
    char letter = (char)(p[1] | 0x20);
    if (p[0] == '&') {
        return letter == 'h' ? 16 : letter == 'o' ? 8 : letter == 'b' ? 2 : 0;
    }
    return p[0] == '0' && letter == 'x' ? 16 : 0;
}

static const char *parse_based(const char *p, const char *end, unsigned base, value_t *out) {
    const char *digits = p + 2;
    uint64_t number = 0;
    for (p = digits; p < end && digit_value(*p) < base; p++) {
        number = number * base + digit_value(*p);
    }
    value_set_integer(out, (int64_t)number);
    return p == digits ? NULL : p;
}

size_t number_text_parse(const char *text, size_t length, value_t *out) {
    const char *p = text;
    const char *end = text + length;
    value_set_integer(out, 0);
    while (p < end && *p == ' ') {
        p++;
    }
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) {
        p++;
    }
    unsigned base = base_of_prefix(p, end);
    num_t number;
    if (base != 0) {
        p = parse_based(p, end, base, out);
    } else if ((p = num_parse(p, end, true, &number)) != NULL) {
        if (number.is_integer) {
            value_set_integer(out, number.integer);
        } else {
            value_set_number(out, number.value);
        }
    }
    if (p == NULL) {
        return 0;
    }
    if (negative && out->type == VALUE_INTEGER) {
        out->integer = (int64_t)(0 - (uint64_t)out->integer);
    } else if (negative) {
        out->number = -out->number;
    }
    return (size_t)(p - text);
}
