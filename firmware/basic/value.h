// A value as it stands on the stack and in a variable, and the conversions between the types.
// Context: main loop.
#ifndef BASIC_VALUE_H
#define BASIC_VALUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef enum {
    VALUE_FLOAT,       // number
    VALUE_INTEGER,     // integer
    VALUE_STRING,      // text, length; on the stack only
    VALUE_NONE,        // a blank argument, or a variable that does not exist yet
    VALUE_FLOAT_REF,   // data: a double elsewhere
    VALUE_INTEGER_REF, // data: an int64_t elsewhere
    VALUE_STRING_REF, // data: a length byte, `capacity` bytes of text; what a string variable holds
    VALUE_ARRAY,      // data: an array_t
    VALUE_WORD,       // text, length: a bare word written as an argument of a command
} value_type_t;

enum {
    VALUE_CONSTANT = 1 << 0, // the variable may not change
    VALUE_LITERAL = 1 << 1,  // argument: written as a plain number
};

typedef struct {
    union {
        double number;
        int64_t integer;
        struct {
            const char *text;
            uint32_t length;
        };
        void *data;
    };
    uint8_t type;
    uint8_t flags;
    uint16_t capacity; // bytes of text a VALUE_STRING_REF can hold
} value_t;

#define VALUE_STRING_MAX 255

static inline bool value_is_numeric(const value_t *value) {
    return value->type <= VALUE_INTEGER;
}

// Turns what a variable or a reference holds into a plain FLOAT, INTEGER or STRING.
void value_fetch(value_t *value);

// Writes `value` (FLOAT, INTEGER or STRING) to the place a reference names, converting numbers.
// Errors: wrong type, string too long.
void value_write(const value_t *reference, const value_t *value);

// The number of a FLOAT or INTEGER. Error: a string.
double value_to_number(const value_t *value);

// The same rounded half away from zero. Error: a string, or beyond 64 bits.
int64_t value_to_integer(const value_t *value);

int64_t value_round(double number);

// IF, NOT: everything but 0 is true.
bool value_is_true(const value_t *value);

// <0, 0, >0; bytewise.
int value_compare_text(const value_t *left, const value_t *right);

// Makes `value` a STRING of these bytes.
void value_set_text(value_t *value, const char *text, size_t length);

// What isfinite() and == 0.0 say, without the library's comparisons, of which each takes half a
// hundred cycles on a board.
static inline uint64_t value_bits(double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static inline bool value_is_finite(double number) {
    return (uint32_t)(value_bits(number) >> 52 & 0x7FF) != 0x7FF;
}

static inline bool value_is_zero(double number) {
    return value_bits(number) << 1 == 0;
}

// <0, 0, >0; for numbers that are no NaN. As integers the bits of two doubles stand in the order of
// the numbers, or against it if both are negative.
static inline int value_order(double left, double right) {
    int64_t left_bits = (int64_t)value_bits(left);
    int64_t right_bits = (int64_t)value_bits(right);
    if ((left_bits ^ right_bits) < 0) { // -0 equals 0
        return (left > right) - (left < right);
    }
    int order = (left_bits > right_bits) - (left_bits < right_bits);
    return left_bits < 0 ? -order : order;
}

static inline void value_set_number(value_t *value, double number) {
    value->number = number;
    value->type = VALUE_FLOAT;
}

static inline void value_set_integer(value_t *value, int64_t integer) {
    value->integer = integer;
    value->type = VALUE_INTEGER;
}

#endif
