// A double as decimal digits, exactly rounded (half away from zero), the same on every target and
// without the C library, whose conversion allocates. Context: main loop.
#ifndef BASIC_DECIMAL_H
#define BASIC_DECIMAL_H

#include <stdint.h>

#define DECIMAL_DIGITS_MAX 17

// The first `count` (1..17) significant digits of `magnitude` (finite, >= 0) as one integer;
// `exponent` becomes the power of ten of the first of them. 0 gives 0 and exponent 0.
uint64_t decimal_significant(double magnitude, int count, int *exponent);

// round(magnitude * 10^decimals). Only for results below 10^17.
uint64_t decimal_scaled(double magnitude, int decimals);

// 10^n for n of 0..19.
uint64_t decimal_power(int n);

#endif
