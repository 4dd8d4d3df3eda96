// A double is m * 2^e; its digits are the integer nearest m * 2^e / 10^s. For the numbers people
// print that takes a product of 128 bits and a shift, or one division of 64 bits; big whole numbers
// do the rest. Context: main loop.
#include "base/decimal.h"

#include <string.h>

#include "base/big.h"

#define FRACTION_BITS 52
#define BIASED_MAX 2047
#define LOG10_2_32 1292913986 // log10(2) * 2^32

static const uint64_t powers_of_ten[20] = {
    1ull,
    10ull,
    100ull,
    1000ull,
    10000ull,
    100000ull,
    1000000ull,
    10000000ull,
    100000000ull,
    1000000000ull,
    10000000000ull,
    100000000000ull,
    1000000000000ull,
    10000000000000ull,
    100000000000000ull,
    1000000000000000ull,
    10000000000000000ull,
    100000000000000000ull,
    1000000000000000000ull,
    10000000000000000000ull,
};

// 5^n as long as it fits.
#define FIVES_MAX 27
static const uint64_t powers_of_five[FIVES_MAX + 1] = {
    1ull,
    5ull,
    25ull,
    125ull,
    625ull,
    3125ull,
    15625ull,
    78125ull,
    390625ull,
    1953125ull,
    9765625ull,
    48828125ull,
    244140625ull,
    1220703125ull,
    6103515625ull,
    30517578125ull,
    152587890625ull,
    762939453125ull,
    3814697265625ull,
    19073486328125ull,
    95367431640625ull,
    476837158203125ull,
    2384185791015625ull,
    11920928955078125ull,
    59604644775390625ull,
    298023223876953125ull,
    1490116119384765625ull,
    7450580596923828125ull,
};

// From here on powers of ten that are doubles themselves; which of them is the next below a number.
#define LISTED_MAX 22
static const double listed_powers[LISTED_MAX + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

typedef struct {
    uint64_t mantissa;
    int exponent; // of two
} binary_t;

static uint64_t bits_of(double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static binary_t take_apart(double magnitude) {
    uint64_t bits = bits_of(magnitude);
    int biased = (int)(bits >> FRACTION_BITS) & BIASED_MAX;
    uint64_t fraction = bits & (((uint64_t)1 << FRACTION_BITS) - 1);
    if (biased == 0) {
        return (binary_t){fraction, 1 - 1023 - FRACTION_BITS};
    }
    return (binary_t){fraction | (uint64_t)1 << FRACTION_BITS, biased - 1023 - FRACTION_BITS};
}

static uint64_t multiply_words(uint64_t a, uint64_t b) {
    return (uint32_t)a * (uint64_t)(uint32_t)b;
}

// round(a * b / 2^shift), or false if that takes more than 64 bits.
static bool multiply_shift(uint64_t a, uint64_t b, int shift, uint64_t *result) {
    uint64_t low = multiply_words(a, b);
    uint64_t middle = multiply_words(a >> 32, b);
    uint64_t high = 0;
    if (b >> 32 != 0) {
        uint64_t other = multiply_words(a, b >> 32);
        middle += other;
        high = multiply_words(a >> 32, b >> 32) + ((uint64_t)(middle < other) << 32);
    }
    low += middle << 32;
    high += (middle >> 32) + (low < (middle << 32));
    if (shift <= 0) {
        bool fits = high == 0 && shift > -64 && low <= UINT64_MAX >> -shift;
        *result = fits ? low << -shift : 0;
        return fits;
    }
    if (shift >= 64) {
        int rest = shift - 64;
        uint64_t up = rest == 0 ? low >> 63 : rest <= 64 ? high >> (rest - 1) & 1 : 0;
        *result = (rest < 64 ? high >> rest : 0) + up;
        return true;
    }
    uint64_t up = low >> (shift - 1) & 1;
    *result = (low >> shift | high << (64 - shift)) + up;
    return high >> shift == 0 && *result >= up;
}

// round(m * 2^e / 10^scale), or false if that has no short way.
static bool divide_quickly(binary_t number, int scale, uint64_t *result) {
    if (scale > 19 || number.exponent > 11) {
        return false;
    }
    uint64_t whole = number.exponent >= 0     ? number.mantissa << number.exponent
                     : number.exponent <= -64 ? 0
                                              : number.mantissa >> -number.exponent;
    uint64_t power = powers_of_ten[scale];
    *result = whole / power;
    *result += whole - *result * power >= power / 2; // what is behind the point cannot change this
    return true;
}

static uint64_t over_power_of_ten_exactly(binary_t number, int scale) {
    big_t numerator, denominator;
    big_set(&numerator, number.mantissa);
    big_set(&denominator, 1);
    int shift = number.exponent - scale; // 10^n is 5^n * 2^n
    big_multiply_power_of_five(scale < 0 ? &numerator : &denominator, scale < 0 ? -scale : scale);
    big_shift_left(shift > 0 ? &numerator : &denominator, shift > 0 ? shift : -shift);
    uint64_t quotient = big_divide(&numerator, &denominator);
    big_shift_left(&numerator, 1);
    return quotient + big_at_least(&numerator, &denominator);
}

// round(number / 10^scale), which has to be below 2^63.
static uint64_t over_power_of_ten(binary_t number, int scale) {
    uint64_t result;
    bool quick =
        scale > 0 ? divide_quickly(number, scale, &result)
                  : -scale <= FIVES_MAX && multiply_shift(number.mantissa, powers_of_five[-scale],
                                                          scale - number.exponent, &result);
    return quick ? result : over_power_of_ten_exactly(number, scale);
}

// Power of ten of the first digit: right, or one too low.
static int first_digit(double magnitude, binary_t number) {
    int bits = 64 - __builtin_clzll(number.mantissa) + number.exponent;
    int guess = (int)(((int64_t)(bits - 1) * LOG10_2_32) >> 32);
    if (guess >= -1 && guess < LISTED_MAX &&
        bits_of(magnitude) >= bits_of(listed_powers[guess + 1])) {
        guess++;
    }
    return guess;
}

bool decimal_scaled(double magnitude, int decimals, uint64_t *scaled) {
    binary_t number = take_apart(magnitude);
    *scaled = 0;
    if (number.mantissa == 0) {
        return true;
    }
    if (decimals <= FIVES_MAX) {
        int shift = -number.exponent - decimals;
        return multiply_shift(number.mantissa, powers_of_five[decimals], shift, scaled) &&
               *scaled < powers_of_ten[DECIMAL_DIGITS_MAX];
    }
    if (first_digit(magnitude, number) + decimals >= DECIMAL_DIGITS_MAX) {
        return false;
    }
    *scaled = over_power_of_ten(number, -decimals);
    return *scaled < powers_of_ten[DECIMAL_DIGITS_MAX];
}

uint64_t decimal_significant(double magnitude, int count, int *exponent) {
    binary_t number = take_apart(magnitude);
    *exponent = 0;
    if (number.mantissa == 0) {
        return 0;
    }
    *exponent = first_digit(magnitude, number);
    uint64_t digits = over_power_of_ten(number, *exponent - count + 1);
    if (digits >= powers_of_ten[count]) {
        (*exponent)++;
        digits = over_power_of_ten(number, *exponent - count + 1);
    }
    return digits;
}
