// A double as decimal digits, exactly rounded (half away from zero) and the same on every target,
// numbers that an RP2040 cannot compute with (below 2.2e-308) included. Context: main loop.
#ifndef BASE_DECIMAL_H
#define BASE_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

#define DECIMAL_DIGITS_MAX 17

// The first `count` (1..17) significant digits of `magnitude` (finite, >= 0) as one integer;
// `exponent` becomes the power of ten of the first of them. 0 gives 0 and exponent 0.
uint64_t decimal_significant(double magnitude, int count, int *exponent);

// round(magnitude * 10^decimals) for 0..30 decimals, or false if that has more than 17 digits.
bool decimal_scaled(double magnitude, int decimals, uint64_t *scaled);

#endif
