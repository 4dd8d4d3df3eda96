// Decimal numerals to double. Up to 19 digits are gathered in an integer; where that integer and
// the power of ten are both exact doubles (15 digits, 10^22: Clinger's fast path) one
// multiplication or division rounds once and is exact. All else is done with whole numbers of any
// length. Context: main loop.
#include "base/num.h"

#include <math.h>
#include <string.h>

#include "base/big.h"

#define MANTISSA_DIGITS_MAX 19
#define EXACT_MANTISSA_MAX ((uint64_t)1 << 53)
#define EXACT_POWER_MAX 22
#define EXPONENT_LIMIT 100000 // beyond this more digits cannot matter
#define SLOW_DIGITS_MAX 800   // the middle between two doubles has at most 767
#define POWER_MOST 310        // of ten: 0.1e310 and above is more than any double
#define POWER_LEAST (-325)    // 0.1e-325 and below is less than half of any

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

// The double nearest to `top` * 2^`exponent`, whose highest bit is set; `more`: a little more than
// that.
static double assemble(uint64_t top, int exponent, bool more) {
    int power = exponent + 63; // of the highest bit
    int dropped = power >= -1022 ? 11 : 11 - 1022 - power;
    if (power > 1023) {
        return HUGE_VAL;
    }
    if (dropped > 64) {
        return 0.0;
    }
    uint64_t mantissa = dropped < 64 ? top >> dropped : 0;
    uint64_t rest = top << (64 - dropped) % 64;
    uint64_t half = (uint64_t)1 << 63;
    mantissa += rest > half || (rest == half && (more || (mantissa & 1) != 0));
    // The mantissa's own highest bit counts one up in the exponent, and so does what rounding
    // carries.
    uint64_t bits = mantissa + (power >= -1022 ? (uint64_t)(power + 1022) << 52 : 0);
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

// digits * 10^power
static double power_of_ten_times(big_t *digits, int power) {
    if (power >= 0) {
        big_multiply_power_of_five(digits, power);
        int drop = big_bits(digits) - 64;
        return assemble(big_extract(digits, drop), drop + power, big_any_below(digits, drop));
    }
    big_t denominator;
    big_set(&denominator, 1);
    big_multiply_power_of_five(&denominator, -power);
    int shift = big_bits(&denominator) + 63 - big_bits(digits); // a quotient of 63 or 64 bits
    big_shift_left(shift > 0 ? digits : &denominator, shift > 0 ? shift : -shift);
    uint64_t quotient = big_divide(digits, &denominator);
    int spare = __builtin_clzll(quotient);
    return assemble(quotient << spare, power - shift - spare, digits->length != 0);
}

// Digits and a point from `text` to `end`, times 10^power. There is a digit other than 0.
static double parse_slowly(const char *text, const char *end, int power) {
    big_t digits;
    big_set(&digits, 0);
    int count = 0;
    int dropped = 0;
    bool more = false;
    for (; text < end; text++) {
        if (*text == '.' || (count == 0 && *text == '0')) {
            continue;
        }
        if (count < SLOW_DIGITS_MAX) {
            big_multiply_add(&digits, 10, (uint32_t)(*text - '0'));
            count++;
        } else {
            more |= *text != '0';
            dropped++;
        }
    }
    if (count + dropped + power > POWER_MOST) {
        return HUGE_VAL;
    }
    if (count + dropped + power < POWER_LEAST) {
        return 0.0;
    }
    if (more) { // one digit that stands for all that are left
        big_multiply_add(&digits, 10, 1);
        dropped--;
    }
    return power_of_ten_times(&digits, power + dropped);
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
        out->value = mantissa == 0 ? 0.0 : parse_slowly(text, after_digits, power);
    }
    return isfinite(out->value) ? p : NULL;
}
