// Decimal numerals to double. Up to 19 digits are gathered in an integer; where that integer and the
// power of ten are both exact doubles (15 digits, 10^22: Clinger's fast path) one multiplication or
// division rounds once and is exact. All else goes to strtod. Context: main loop.
#include "base/num.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MANTISSA_DIGITS_MAX 19
#define EXACT_MANTISSA_MAX ((uint64_t)1 << 53)
#define EXACT_POWER_MAX 22
#define EXPONENT_LIMIT 100000 // beyond this more digits cannot matter
#define SLOW_TEXT_SIZE 320    // digits handed to strtod; more than the 309 of DBL_MAX

static const double exact_powers[EXACT_POWER_MAX + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// The exponent part at `text`, or `text` itself if there is none.
static const char *parse_exponent(const char *text, const char *end, int *exponent) {
    const char *p = text;
    if (p == end || (*p != 'e' && *p != 'E')) {
        return text;
    }
    p++;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) {
        p++;
    }
    if (p == end || !is_digit(*p)) {
        return text;
    }
    int value = 0;
    for (; p < end && is_digit(*p); p++) {
        if (value < EXPONENT_LIMIT) {
            value = value * 10 + (*p - '0');
        }
    }
    *exponent = negative ? -value : value;
    return p;
}

static double parse_slowly(const char *text, const char *end) {
    char copy[SLOW_TEXT_SIZE];
    size_t length = (size_t)(end - text);
    if (length >= sizeof copy) {
        length = sizeof copy - 1;
    }
    memcpy(copy, text, length);
    copy[length] = '\0';
    return strtod(copy, NULL);
}

const char *num_parse(const char *text, const char *end, bool allow_exponent, num_t *out) {
    uint64_t mantissa = 0;
    int digits = 0;   // significant ones gathered in the mantissa
    int dropped = 0;  // significant ones that no longer fit
    int decimals = 0; // digits behind the point, gathered or not
    bool any = false;
    bool point = false;
    const char *p = text;
    for (; p < end && (is_digit(*p) || (*p == '.' && !point)); p++) {
        if (*p == '.') {
            point = true;
            continue;
        }
        any = true;
        decimals += point;
        if (digits == MANTISSA_DIGITS_MAX) {
            dropped++;
        } else if (mantissa != 0 || *p != '0') {
            mantissa = mantissa * 10 + (uint64_t)(*p - '0');
            digits++;
        }
    }
    if (!any) {
        return NULL;
    }

    int exponent = 0;
    const char *after_digits = p;
    if (allow_exponent) {
        p = parse_exponent(p, end, &exponent);
    }

    out->is_integer = !point && p == after_digits && dropped == 0 && mantissa <= INT64_MAX;
    out->integer = out->is_integer ? (int64_t)mantissa : 0;
    int power = exponent - decimals;
    if (dropped == 0 && mantissa < EXACT_MANTISSA_MAX && power >= -EXACT_POWER_MAX &&
        power <= EXACT_POWER_MAX) {
        double whole = (double)mantissa;
        out->value = power < 0 ? whole / exact_powers[-power] : whole * exact_powers[power];
    } else {
        out->value = parse_slowly(text, p);
    }
    return isfinite(out->value) ? p : NULL;
}
