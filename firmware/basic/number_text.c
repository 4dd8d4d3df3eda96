// Numbers as text and text as numbers. Context: main loop.
#include "number_text.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "decimal.h"

#define PRINT_DIGITS 10
#define PRINT_FIXED_BELOW 1000000.0
#define PRINT_FIXED_FROM 0.0001

// Appends `number` with leading zeros to `width` digits.
static char *put_digits(char *p, uint64_t number, int width) {
    char digits[24];
    int count = 0;
    do {
        digits[count++] = (char)('0' + number % 10);
        number /= 10;
    } while (number != 0);
    for (int i = count; i < width; i++) {
        *p++ = '0';
    }
    while (count > 0) {
        *p++ = digits[--count];
    }
    return p;
}

static char *put_zeros(char *p, int count) {
    while (count-- > 0) {
        *p++ = '0';
    }
    return p;
}

static size_t finish(char *buffer, char *p) {
    *p = '\0';
    return (size_t)(p - buffer);
}

static size_t put_special(char *buffer, double number) {
    strcpy(buffer, isnan(number) ? "nan" : number < 0 ? "-inf" : "inf");
    return strlen(buffer);
}

// Takes zeros behind a point away, and the point if nothing is left.
static char *strip_zeros(char *start, char *p) {
    if (memchr(start, '.', (size_t)(p - start)) == NULL) {
        return p;
    }
    while (p[-1] == '0') {
        p--;
    }
    return p[-1] == '.' ? p - 1 : p;
}

static char *put_mantissa(char *p, uint64_t digits, int decimals, bool strip) {
    uint64_t unit = decimal_power(decimals);
    char *start = p;
    p = put_digits(p, digits / unit, 1);
    if (decimals > 0) {
        *p++ = '.';
        p = put_digits(p, digits % unit, decimals);
    }
    return strip ? strip_zeros(start, p) : p;
}

static char *put_power(char *p, int exponent) {
    *p++ = 'e';
    *p++ = exponent < 0 ? '-' : '+';
    return put_digits(p, (uint64_t)(exponent < 0 ? -exponent : exponent), 2);
}

static char *put_scientific(char *p, double magnitude, int decimals, bool strip) {
    int exponent;
    int exact = decimals < DECIMAL_DIGITS_MAX ? decimals : DECIMAL_DIGITS_MAX - 1;
    uint64_t digits = decimal_significant(magnitude, exact + 1, &exponent);
    p = put_mantissa(p, digits, exact, strip);
    if (!strip) {
        p = put_zeros(p, decimals - exact);
    }
    return put_power(p, exponent);
}

// A magnitude below 1 with more decimals than 64 bits hold.
static char *put_fraction(char *p, double magnitude, int exponent, int decimals) {
    int count = decimals + exponent + 1;
    int shown = 0;
    *p++ = '0';
    *p++ = '.';
    if (count > 0) {
        count = count < DECIMAL_DIGITS_MAX ? count : DECIMAL_DIGITS_MAX;
        uint64_t digits = decimal_significant(magnitude, count, &exponent);
        p = put_zeros(p, -exponent - 1);
        p = put_digits(p, digits, count);
        shown = count - exponent - 1;
    }
    return put_zeros(p, decimals - shown);
}

static char *put_fixed(char *p, double magnitude, int decimals) {
    int exponent;
    uint64_t digits = decimal_significant(magnitude, DECIMAL_DIGITS_MAX, &exponent);
    if (exponent + decimals < DECIMAL_DIGITS_MAX - 1 && decimals < DECIMAL_DIGITS_MAX) {
        return put_mantissa(p, decimal_scaled(magnitude, decimals), decimals, false);
    }
    if (exponent < 0) {
        return put_fraction(p, magnitude, exponent, decimals);
    }
    int shown_decimals = DECIMAL_DIGITS_MAX - 1 - exponent; // of the exact digits
    if (shown_decimals >= 0) {
        p = put_mantissa(p, digits, shown_decimals, false);
        if (shown_decimals == 0 && decimals > 0) {
            *p++ = '.';
        }
        return put_zeros(p, decimals - shown_decimals);
    }
    p = put_digits(p, digits, 1);
    p = put_zeros(p, -shown_decimals);
    if (decimals > 0) {
        *p++ = '.';
    }
    return put_zeros(p, decimals);
}

// Writes the sign of a negative number and makes it positive; -0.0 has none.
static char *put_sign(char *p, double *number) {
    if (*number < 0) {
        *p++ = '-';
        *number = -*number;
    }
    return p;
}

size_t number_text_fixed(char *buffer, double number, int decimals) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    if (decimals > NUMBER_TEXT_DECIMALS_MAX) {
        decimals = NUMBER_TEXT_DECIMALS_MAX;
    }
    char *p = put_sign(buffer, &number);
    return finish(buffer, put_fixed(p, number, decimals));
}

size_t number_text_exponent(char *buffer, double number, int decimals) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    if (decimals > NUMBER_TEXT_DECIMALS_MAX) {
        decimals = NUMBER_TEXT_DECIMALS_MAX;
    }
    char *p = put_sign(buffer, &number);
    return finish(buffer, put_scientific(p, number, decimals, false));
}

size_t number_text_general(char *buffer, double number, int digits) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    if (digits < 1) {
        digits = 1;
    } else if (digits > DECIMAL_DIGITS_MAX) {
        digits = DECIMAL_DIGITS_MAX;
    }
    char *p = put_sign(buffer, &number);
    int exponent;
    decimal_significant(number, digits, &exponent);
    if (exponent < -4 || exponent >= digits) {
        return finish(buffer, put_scientific(p, number, digits - 1, true));
    }
    char *start = p;
    p = put_fixed(p, number, digits - 1 - exponent);
    return finish(buffer, strip_zeros(start, p));
}

size_t number_text_float(char *buffer, double number) {
    double magnitude = fabs(number);
    if (!isfinite(number) || magnitude == 0.0 ||
        (magnitude < PRINT_FIXED_BELOW && magnitude >= PRINT_FIXED_FROM)) {
        return number_text_general(buffer, number, PRINT_DIGITS);
    }
    char *p = put_sign(buffer, &number);
    return finish(buffer, put_scientific(p, number, PRINT_DIGITS - 1, true));
}

size_t number_text_integer(char *buffer, int64_t integer) {
    char *p = buffer;
    uint64_t magnitude = (uint64_t)integer;
    if (integer < 0) {
        *p++ = '-';
        magnitude = 0 - magnitude;
    }
    return finish(buffer, put_digits(p, magnitude, 1));
}

size_t number_text_value(char *buffer, const value_t *value) {
    return value->type == VALUE_INTEGER ? number_text_integer(buffer, value->integer)
                                        : number_text_float(buffer, value_to_number(value));
}

size_t number_text_base(char *buffer, uint64_t number, unsigned base, size_t width) {
    char digits[64];
    size_t count = 0;
    do {
        digits[count++] = "0123456789ABCDEF"[number % base];
        number /= base;
    } while (number != 0);
    char *p = buffer;
    for (size_t i = count; i < width; i++) {
        *p++ = '0';
    }
    while (count > 0) {
        *p++ = digits[--count];
    }
    return finish(buffer, p);
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
