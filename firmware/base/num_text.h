// Numbers as decimal text, exactly rounded (half away from zero) and the same on every target,
// without the C library, whose conversion allocates. Context: main loop.
#ifndef BASE_NUM_TEXT_H
#define BASE_NUM_TEXT_H

#include <stddef.h>
#include <stdint.h>

// Room for any text these functions make; decimals beyond NUM_TEXT_DECIMALS_MAX are not given.
#define NUM_TEXT_SIZE 360
#define NUM_TEXT_DECIMALS_MAX 30

// All write a zero-terminated text to `buffer` and return its length. No leading blank. Of a double
// at most 17 digits are meaningful; behind them come zeros. Not numbers: nan, inf, -inf.

// 12.50: always `decimals` digits behind the point.
size_t num_text_fixed(char *buffer, double number, int decimals);

// 1.25e+01: always `decimals` digits behind the point.
size_t num_text_exponent(char *buffer, double number, int decimals);

// The same with up to `digits` digits in all, without zeros at the end: 1.25e+01, 1e+06.
size_t num_text_short_exponent(char *buffer, double number, int digits);

// C's %g: `digits` significant ones without zeros at the end, in the shorter of both forms.
size_t num_text_general(char *buffer, double number, int digits);

size_t num_text_integer(char *buffer, int64_t integer);

// In base 2..16, at least `width` digits.
size_t num_text_unsigned(char *buffer, uint64_t number, unsigned base, size_t width);

#endif
