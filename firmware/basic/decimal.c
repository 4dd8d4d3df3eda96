// A double is m * 2^e; its digits are the integer nearest m * 2^e / 10^s, and big whole numbers give it
// without error. For all common numbers the division is a shift. Context: main loop.
#include "decimal.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define WORDS 44 // 10^342 * 2^53 needs 37
#define QUOTIENT_BITS 60

typedef struct {
    uint32_t words[WORDS]; // lowest first
    int length;            // words in use
} big_t;

static void big_set(big_t *big, uint64_t value) {
    big->words[0] = (uint32_t)value;
    big->words[1] = (uint32_t)(value >> 32);
    big->length = 2;
}

static void big_multiply(big_t *big, uint32_t factor) {
    uint64_t carry = 0;
    for (int i = 0; i < big->length; i++) {
        carry += (uint64_t)big->words[i] * factor;
        big->words[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0) {
        big->words[big->length++] = (uint32_t)carry;
    }
}

static void big_multiply_power_of_ten(big_t *big, int power) {
    for (; power >= 9; power -= 9) {
        big_multiply(big, 1000000000u);
    }
    big_multiply(big, (uint32_t)decimal_power(power));
}

static void big_shift_left(big_t *big, int bits) {
    int words = bits / 32;
    memmove(big->words + words, big->words, (size_t)big->length * sizeof big->words[0]);
    memset(big->words, 0, (size_t)words * sizeof big->words[0]);
    big->length += words;
    big_multiply(big, (uint32_t)1 << bits % 32);
}

static void big_halve(big_t *big) {
    for (int i = 0; i < big->length; i++) {
        uint32_t above = i + 1 < big->length ? big->words[i + 1] : 0;
        big->words[i] = big->words[i] >> 1 | above << 31;
    }
}

static uint32_t big_word(const big_t *big, int i) {
    return i < big->length ? big->words[i] : 0;
}

static bool big_at_least(const big_t *left, const big_t *right) {
    int i = left->length > right->length ? left->length : right->length;
    while (i-- > 0) {
        if (big_word(left, i) != big_word(right, i)) {
            return big_word(left, i) > big_word(right, i);
        }
    }
    return true;
}

// left -= right; right is not the larger one.
static void big_subtract(big_t *left, const big_t *right) {
    int64_t borrow = 0;
    for (int i = 0; i < left->length; i++) {
        borrow += (int64_t)left->words[i] - big_word(right, i);
        left->words[i] = (uint32_t)borrow;
        borrow >>= 32;
    }
}

// round(big / 2^shift), shift >= 1; the result fits 64 bits.
static uint64_t shifted(const big_t *big, int shift) {
    int word = (shift - 1) / 32;
    int bit = (shift - 1) % 32;
    uint64_t low = (uint64_t)big_word(big, word + 1) << 32 | big_word(big, word);
    uint64_t value = low >> bit; // one bit more than the quotient
    if (bit > 0) {
        value |= (uint64_t)big_word(big, word + 2) << (64 - bit);
    }
    return (value >> 1) + (value & 1);
}

// round(numerator / denominator), which is below 2^QUOTIENT_BITS.
static uint64_t divided(big_t *numerator, big_t *denominator) {
    uint64_t quotient = 0;
    big_shift_left(denominator, QUOTIENT_BITS);
    for (int bit = 0; bit <= QUOTIENT_BITS; bit++) {
        quotient <<= 1;
        if (big_at_least(numerator, denominator)) {
            big_subtract(numerator, denominator);
            quotient |= 1;
        }
        if (bit < QUOTIENT_BITS) {
            big_halve(denominator);
        }
    }
    big_multiply(numerator, 2);
    return quotient + big_at_least(numerator, denominator);
}

// round(magnitude / 10^scale)
static uint64_t over_power_of_ten(double magnitude, int scale) {
    int exponent;
    double fraction = frexp(magnitude, &exponent);
    uint64_t mantissa = (uint64_t)ldexp(fraction, 53);
    exponent -= 53;

    big_t numerator;
    big_set(&numerator, mantissa);
    if (scale < 0) {
        big_multiply_power_of_ten(&numerator, -scale);
    }
    if (exponent > 0) {
        big_shift_left(&numerator, exponent);
    }
    if (scale <= 0 && exponent < 0) {
        return shifted(&numerator, -exponent);
    }
    big_t denominator;
    big_set(&denominator, 1);
    if (scale > 0) {
        big_multiply_power_of_ten(&denominator, scale);
    }
    if (exponent < 0) {
        big_shift_left(&denominator, -exponent);
    }
    return divided(&numerator, &denominator);
}

uint64_t decimal_power(int n) {
    uint64_t power = 1;
    while (n-- > 0) {
        power *= 10;
    }
    return power;
}

uint64_t decimal_scaled(double magnitude, int decimals) {
    return magnitude == 0.0 ? 0 : over_power_of_ten(magnitude, -decimals);
}

uint64_t decimal_significant(double magnitude, int count, int *exponent) {
    *exponent = 0;
    if (magnitude == 0.0) {
        return 0;
    }
    int binary;
    frexp(magnitude, &binary);
    *exponent = (int)floor((binary - 1) * 0.30102999566398120); // log10(2); right or one too low
    uint64_t digits = over_power_of_ten(magnitude, *exponent - count + 1);
    if (digits >= decimal_power(count)) {
        (*exponent)++;
        digits = over_power_of_ten(magnitude, *exponent - count + 1);
    }
    return digits;
}
