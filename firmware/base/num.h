// Reads decimal numbers fast and exactly: the same text gives the same double on every target.
// Context: main loop.
#ifndef BASE_NUM_H
#define BASE_NUM_H

#include <stdbool.h>
#include <stdint.h>

// What a numeral turned out to be.
typedef struct {
    double value;    // correctly rounded
    int64_t integer; // the same number if `is_integer`
    bool is_integer; // no point, no exponent, and it fits 64 bits
} num_t;

// Reads digits [. digits] [E [sign] digits] from `text` up to `end`; no sign, no blanks, no
// hexadecimal, no NaN or infinity. The exponent is taken only with `allow_exponent` (G-code has
// none: there an E is the next word) and only if digits follow it.
// Returns the place behind the numeral, or NULL if there is no digit or the number is beyond
// double.
const char *num_parse(const char *text, const char *end, bool allow_exponent, num_t *out);

#endif
