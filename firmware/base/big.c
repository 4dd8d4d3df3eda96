// Whole numbers of many words. Context: main loop.
#include "base/big.h"

#include <string.h>

#define FIVE_TO_13 1220703125u // the largest power of five in a word

static uint32_t word_of(const big_t *big, int i) {
    return i >= 0 && i < big->length ? big->words[i] : 0;
}

static void trim(big_t *big) {
    while (big->length > 0 && big->words[big->length - 1] == 0) {
        big->length--;
    }
}

void big_set(big_t *big, uint64_t value) {
    big->words[0] = (uint32_t)value;
    big->words[1] = (uint32_t)(value >> 32);
    big->length = 2;
    trim(big);
}

void big_multiply_add(big_t *big, uint32_t factor, uint32_t addend) {
    uint64_t carry = addend;
    for (int i = 0; i < big->length; i++) {
        carry += (uint64_t)big->words[i] * factor;
        big->words[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0) {
        big->words[big->length++] = (uint32_t)carry;
    }
}

void big_multiply_power_of_five(big_t *big, int power) {
    for (; power >= 13; power -= 13) {
        big_multiply_add(big, FIVE_TO_13, 0);
    }
    uint32_t rest = 1;
    while (power-- > 0) {
        rest *= 5;
    }
    big_multiply_add(big, rest, 0);
}

void big_shift_left(big_t *big, int bits) {
    int words = bits / 32;
    if (big->length == 0) {
        return;
    }
    memmove(big->words + words, big->words, (size_t)big->length * sizeof big->words[0]);
    memset(big->words, 0, (size_t)words * sizeof big->words[0]);
    big->length += words;
    big_multiply_add(big, (uint32_t)1 << bits % 32, 0);
}

int big_bits(const big_t *big) {
    return big->length == 0 ? 0 : 32 * big->length - __builtin_clz(big->words[big->length - 1]);
}

uint64_t big_extract(const big_t *big, int from) {
    int word = from >= 0 ? from / 32 : -((31 - from) / 32);
    int bit = from - 32 * word;
    uint64_t low = (uint64_t)word_of(big, word + 1) << 32 | word_of(big, word);
    return bit == 0 ? low : low >> bit | (uint64_t)word_of(big, word + 2) << (64 - bit);
}

bool big_any_below(const big_t *big, int end) {
    for (int i = 0; i < big->length && 32 * i < end; i++) {
        int bits = end - 32 * i;
        uint32_t mask = bits >= 32 ? UINT32_MAX : ((uint32_t)1 << bits) - 1;
        if ((big->words[i] & mask) != 0) {
            return true;
        }
    }
    return false;
}

bool big_at_least(const big_t *left, const big_t *right) {
    if (left->length != right->length) {
        return left->length > right->length;
    }
    for (int i = left->length - 1; i >= 0; i--) {
        if (left->words[i] != right->words[i]) {
            return left->words[i] > right->words[i];
        }
    }
    return true;
}

// numerator -= denominator * 2^(32 place) * factor, modulo 2^(32 (place + length + 1)). Returns the
// borrow.
static bool subtract_multiple(uint32_t *numerator, const big_t *denominator, uint32_t factor) {
    uint64_t carry = 0;
    for (int i = 0; i < denominator->length; i++) {
        carry += (uint64_t)denominator->words[i] * factor;
        uint32_t low = (uint32_t)carry;
        carry = (carry >> 32) + (numerator[i] < low);
        numerator[i] -= low;
    }
    uint32_t *top = &numerator[denominator->length];
    bool borrow = *top < carry;
    *top -= (uint32_t)carry;
    return borrow;
}

static bool add_back(uint32_t *numerator, const big_t *denominator) {
    uint64_t carry = 0;
    for (int i = 0; i < denominator->length; i++) {
        carry += (uint64_t)numerator[i] + denominator->words[i];
        numerator[i] = (uint32_t)carry;
        carry >>= 32;
    }
    uint32_t *top = &numerator[denominator->length];
    carry += *top;
    *top = (uint32_t)carry;
    return carry >> 32 != 0;
}

// One word of the quotient, as in long division by hand: guessed from the highest words, at most
// two too large because the denominator's highest bit is set.
static uint32_t divide_step(uint32_t *numerator, const big_t *denominator) {
    int length = denominator->length;
    uint32_t highest = denominator->words[length - 1];
    uint64_t upper = (uint64_t)numerator[length] << 32 | numerator[length - 1];
    uint32_t guess = numerator[length] >= highest ? UINT32_MAX : (uint32_t)(upper / highest);
    bool negative = subtract_multiple(numerator, denominator, guess);
    while (negative) {
        guess--;
        negative = !add_back(numerator, denominator);
    }
    return guess;
}

uint64_t big_divide(big_t *numerator, big_t *denominator) {
    int shift = __builtin_clz(denominator->words[denominator->length - 1]);
    big_shift_left(numerator, shift);
    big_shift_left(denominator, shift);
    int length = denominator->length + 2;
    while (numerator->length < length) {
        numerator->words[numerator->length++] = 0;
    }
    uint64_t high = divide_step(numerator->words + 1, denominator);
    uint64_t low = divide_step(numerator->words, denominator);
    trim(numerator);
    return high << 32 | low;
}
