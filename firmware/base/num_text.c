// Numbers as text. Digits come from decimal.h as an integer, which is cut into digits with as few
// divisions as possible: a core without a divider of 64 bits spends its time there. Context: main
// loop.
#include "base/num_text.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/decimal.h"

#define DIGITS_SIZE 20 // of 2^64 - 1
#define EIGHT_DIGITS 100000000u
#define FOUR_DIGITS 10000u

// ---- Digits -------------------------------------------------------------------------------------

// Writes the four digits of `number` before `end`.
static void put_four(char *end, uint32_t number) {
    for (int i = 1; i <= 4; i++) {
        uint32_t tenth = (number * 6554u) >> 16; // number / 10, right up to 16388
        end[-i] = (char)('0' + (number - tenth * 10));
        number = tenth;
    }
}

// Writes the digits before `end` and returns where they start; 0 has none.
static char *put_backwards(char *end, uint64_t number) {
    char *p = end;
    while (number >> 32 != 0) {
        uint64_t rest = number / EIGHT_DIGITS;
        uint32_t part = (uint32_t)(number - rest * EIGHT_DIGITS);
        put_four(p, part % FOUR_DIGITS);
        put_four(p - 4, part / FOUR_DIGITS);
        p -= 8;
        number = rest;
    }
    for (uint32_t left = (uint32_t)number; left != 0; p -= 4) {
        uint32_t rest = left / FOUR_DIGITS;
        put_four(p, left - rest * FOUR_DIGITS);
        left = rest;
    }
    while (p < end && *p == '0') {
        p++;
    }
    return p;
}

// Some digits of a number, the first one not 0.
typedef struct {
    char text[DIGITS_SIZE + 4];
    const char *first;
    int count;
} digits_t;

static void cut(digits_t *digits, uint64_t number) {
    char *end = digits->text + sizeof digits->text;
    digits->first = put_backwards(end, number);
    digits->count = (int)(end - digits->first);
}

static void strip_zeros(digits_t *digits) {
    while (digits->count > 1 && digits->first[digits->count - 1] == '0') {
        digits->count--;
    }
}

// ---- Text ---------------------------------------------------------------------------------------

static char *put_zeros(char *p, int count) {
    while (count-- > 0) {
        *p++ = '0';
    }
    return p;
}

static char *put_text(char *p, const char *text, int count) {
    while (count-- > 0) {
        *p++ = *text++;
    }
    return p;
}

static size_t finish(char *buffer, char *p) {
    *p = '\0';
    return (size_t)(p - buffer);
}

static size_t put_special(char *buffer, double number) {
    strcpy(buffer, isnan(number) ? "nan" : signbit(number) ? "-inf" : "inf");
    return strlen(buffer);
}

// Writes the sign of a negative number and makes it positive; -0.0 has none. By its bits: an RP2040
// compares the smallest doubles as if they were 0.
static char *put_sign(char *p, double *number) {
    uint64_t bits;
    memcpy(&bits, number, sizeof bits);
    if (bits >> 63 != 0) {
        bits &= INT64_MAX;
        memcpy(number, &bits, sizeof bits);
        if (bits != 0) {
            *p++ = '-';
        }
    }
    return p;
}

// The digits with a point behind `whole` of them (may be none, or more than there are), then zeros
// up to `decimals` behind the point.
static char *put_point(char *p, const digits_t *digits, int whole, int decimals) {
    int before = whole < 0 ? 0 : whole < digits->count ? whole : digits->count;
    if (whole <= 0) {
        *p++ = '0';
    }
    p = put_text(p, digits->first, before);
    p = put_zeros(p, whole - before);
    if (decimals <= 0) {
        return p;
    }
    *p++ = '.';
    int zeros = whole < 0 ? (-whole < decimals ? -whole : decimals) : 0;
    p = put_zeros(p, zeros);
    int after = digits->count - before;
    after = after < decimals - zeros ? after : decimals - zeros;
    p = put_text(p, digits->first + before, after);
    return put_zeros(p, decimals - zeros - after);
}

// One digit before the point, `decimals` behind it, and the exponent.
static char *put_scientific(char *p, const digits_t *digits, int exponent, int decimals) {
    p = put_point(p, digits, 1, decimals);
    *p++ = 'e';
    *p++ = exponent < 0 ? '-' : '+';
    int size = exponent < 0 ? -exponent : exponent;
    if (size >= 100) {
        *p++ = (char)('0' + size / 100);
    }
    *p++ = (char)('0' + size / 10 % 10);
    *p++ = (char)('0' + size % 10);
    return p;
}

// Up to `count` digits, rounded, without zeros at their end.
static int significant(digits_t *digits, double magnitude, int count) {
    int exponent;
    uint64_t number = decimal_significant(magnitude, count, &exponent);
    cut(digits, number);
    if (number == 0) {
        digits->first = "0";
        digits->count = 1;
    }
    strip_zeros(digits);
    return exponent;
}

static int limited(int value, int least, int most) {
    return value < least ? least : value > most ? most : value;
}

// ---- Face ---------------------------------------------------------------------------------------

size_t num_text_fixed(char *buffer, double number, int decimals) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    decimals = limited(decimals, 0, NUM_TEXT_DECIMALS_MAX);
    char *p = put_sign(buffer, &number);
    digits_t digits;
    uint64_t scaled;
    if (decimal_scaled(number, decimals, &scaled)) {
        cut(&digits, scaled);
        return finish(buffer, put_point(p, &digits, digits.count - decimals, decimals));
    }
    int exponent = significant(&digits, number, DECIMAL_DIGITS_MAX);
    return finish(buffer, put_point(p, &digits, exponent + 1, decimals));
}

size_t num_text_exponent(char *buffer, double number, int decimals) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    decimals = limited(decimals, 0, NUM_TEXT_DECIMALS_MAX);
    char *p = put_sign(buffer, &number);
    digits_t digits;
    int exponent = significant(&digits, number, limited(decimals + 1, 1, DECIMAL_DIGITS_MAX));
    return finish(buffer, put_scientific(p, &digits, exponent, decimals));
}

size_t num_text_short_exponent(char *buffer, double number, int count) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    char *p = put_sign(buffer, &number);
    digits_t digits;
    int exponent = significant(&digits, number, limited(count, 1, DECIMAL_DIGITS_MAX));
    return finish(buffer, put_scientific(p, &digits, exponent, digits.count - 1));
}

size_t num_text_general(char *buffer, double number, int count) {
    if (!isfinite(number)) {
        return put_special(buffer, number);
    }
    count = limited(count, 1, DECIMAL_DIGITS_MAX);
    char *p = put_sign(buffer, &number);
    digits_t digits;
    int exponent = significant(&digits, number, count);
    if (exponent < -4 || exponent >= count) {
        return finish(buffer, put_scientific(p, &digits, exponent, digits.count - 1));
    }
    return finish(buffer, put_point(p, &digits, exponent + 1, digits.count - 1 - exponent));
}

size_t num_text_integer(char *buffer, int64_t integer) {
    char *p = buffer;
    uint64_t magnitude = (uint64_t)integer;
    if (integer < 0) {
        *p++ = '-';
        magnitude = 0 - magnitude;
    }
    digits_t digits;
    cut(&digits, magnitude);
    if (magnitude == 0) {
        *p++ = '0';
    }
    return finish(buffer, put_text(p, digits.first, digits.count));
}

size_t num_text_unsigned(char *buffer, uint64_t number, unsigned base, size_t width) {
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
