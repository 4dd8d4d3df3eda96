// Numbers as text, by MMBasic's rules. Context: main loop.
#ifndef BASIC_NUMBER_TEXT_H
#define BASIC_NUMBER_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "value.h"

// Room for any text these functions make; with `decimals` up to NUMBER_TEXT_DECIMALS_MAX.
#define NUMBER_TEXT_SIZE 360
#define NUMBER_TEXT_DECIMALS_MAX 30

// All write a zero-terminated text to `buffer` and return its length. No leading blank.

// As PRINT does: 10 significant digits, no trailing zeros, 1.5e+06 from a million and below 0.0001.
size_t number_text_float(char *buffer, double number);
size_t number_text_integer(char *buffer, int64_t integer);
size_t number_text_value(char *buffer, const value_t *value);

// 12.50: always `decimals` digits behind the point.
size_t number_text_fixed(char *buffer, double number, int decimals);

// 1.25e+01
size_t number_text_exponent(char *buffer, double number, int decimals);

// C's %g: `digits` significant ones, the shorter of both forms.
size_t number_text_general(char *buffer, double number, int digits);

// Unsigned digits in base 2, 8 or 16, at least `width` of them.
size_t number_text_base(char *buffer, uint64_t number, unsigned base, size_t width);

// Reads a number at the start of the text, after blanks: sign, decimal or &H &O &B (0x too).
// `used` is how many characters belong to it, 0 if there is none (then the value is 0).
size_t number_text_parse(const char *text, size_t length, value_t *out);

#endif
