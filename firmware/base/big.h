// Whole numbers of up to 2816 bits, enough to convert any double from or to decimal without an
// error. Context: main loop; a number takes 360 bytes of the caller's stack.
#ifndef BASE_BIG_H
#define BASE_BIG_H

#include <stdbool.h>
#include <stdint.h>

// The longest is 5^1124, for a numeral of 800 digits near the smallest double, and 64 bits of
// quotient.
#define BIG_WORDS 88

typedef struct {
    uint32_t words[BIG_WORDS]; // lowest first
    int length;                // words in use; the highest is not 0, and 0 has none
} big_t;

void big_set(big_t *big, uint64_t value);

// big = big * factor + addend
void big_multiply_add(big_t *big, uint32_t factor, uint32_t addend);

// big *= 5^power
void big_multiply_power_of_five(big_t *big, int power);

// big *= 2^bits
void big_shift_left(big_t *big, int bits);

// How many bits the number has; 0 has none.
int big_bits(const big_t *big);

// The 64 bits from bit `from` on (may be negative: zeros follow the last).
uint64_t big_extract(const big_t *big, int from);

// True if a bit below bit `end` is set.
bool big_any_below(const big_t *big, int end);

// Divides; `numerator` becomes the remainder. The quotient has to be below 2^64. Both are shifted
// by the same number of bits, at most 31, on the way: the remainder counts against the denominator
// as it is then.
uint64_t big_divide(big_t *numerator, big_t *denominator);

// True if left >= right.
bool big_at_least(const big_t *left, const big_t *right);

#endif
