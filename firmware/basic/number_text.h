// Numbers as text, by MMBasic's rules. Context: main loop.
#ifndef BASIC_NUMBER_TEXT_H
#define BASIC_NUMBER_TEXT_H

#include <stddef.h>

#include "base/base.h"
#include "value.h"

#define NUMBER_TEXT_SIZE NUM_TEXT_SIZE // room for any text these functions make

// Both write a zero-terminated text to `buffer` and return its length. No leading blank.
// As PRINT does: 10 significant digits, no trailing zeros, 1.5e+06 from a million and below 0.0001.
size_t number_text_float(char *buffer, double number);
size_t number_text_value(char *buffer, const value_t *value);

// Reads a number at the start of the text, after blanks: sign, decimal or &H &O &B (0x too).
// `used` is how many characters belong to it, 0 if there is none (then the value is 0).
size_t number_text_parse(const char *text, size_t length, value_t *out);

#endif
