// Formatted text. Context: any, as the header says.
#include "base/format.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/num_text.h"

#define INTEGER_SIZE 68 // 64 binary digits, though none asks for them
#define PRECISION_DEFAULT 6

typedef struct {
    char *buffer;
    size_t size;
    size_t length; // of all that was put, whether it fitted or not
} sink_t;

// One %-specification.
typedef struct {
    bool left, zeros;
    char plus;     // '+', ' ' or 0: stands before a number that has no minus
    int width;     // at least
    int precision; // -1: none
    int size;      // of an integer: 0 int, 1 long, 2 long long, -1 short, -2 char, 3 size_t
} field_t;

static void put(sink_t *sink, char c) {
    if (sink->length + 1 < sink->size) {
        sink->buffer[sink->length] = c;
    }
    sink->length++;
}

static void put_many(sink_t *sink, char c, int count) {
    while (count-- > 0) {
        put(sink, c);
    }
}

// The text in its field; `sign` characters of it stay in front of filling zeros.
static void put_field(sink_t *sink, const field_t *field, const char *text, size_t length,
                      bool zeros) {
    int fill = field->width - (int)length;
    size_t sign = zeros && length > 0 && (*text == '-' || *text == '+' || *text == ' ') ? 1 : 0;
    if (!field->left && !zeros) {
        put_many(sink, ' ', fill);
    }
    for (size_t i = 0; i < length; i++) {
        if (i == sign && zeros && !field->left) {
            put_many(sink, '0', fill);
        }
        put(sink, text[i]);
    }
    if (field->left) {
        put_many(sink, ' ', fill);
    }
}

// ---- Reading the format -------------------------------------------------------------------------

static const char *read_count(const char *p, va_list *args, int *count) {
    if (*p == '*') {
        *count = va_arg(*args, int);
        return p + 1;
    }
    for (*count = 0; *p >= '0' && *p <= '9'; p++) {
        *count = *count < 1000 ? *count * 10 + (*p - '0') : *count;
    }
    return p;
}

static const char *read_size(const char *p, int *size) {
    for (; *p == 'l' || *p == 'h' || *p == 'z'; p++) {
        *size = *p == 'l' ? *size + 1 : *p == 'h' ? *size - 1 : 3;
    }
    return p;
}

// Reads what stands between % and the letter.
static const char *read_field(const char *p, va_list *args, field_t *field) {
    *field = (field_t){.precision = -1};
    for (; *p != '\0' && strchr("-0+ ", *p) != NULL; p++) {
        field->left |= *p == '-';
        field->zeros |= *p == '0';
        if (*p == '+' || (*p == ' ' && field->plus == 0)) {
            field->plus = *p;
        }
    }
    p = read_count(p, args, &field->width);
    if (field->width < 0) {
        field->left = true;
        field->width = -field->width;
    }
    if (*p == '.') {
        p = read_count(p + 1, args, &field->precision);
    }
    return read_size(p, &field->size);
}

// ---- Conversions --------------------------------------------------------------------------------

static int64_t signed_argument(va_list *args, int size) {
    switch (size) {
    case 1:
        return va_arg(*args, long);
    case 2:
        return va_arg(*args, long long);
    case 3:
        return (int64_t)va_arg(*args, size_t);
    default:
        return va_arg(*args, int);
    }
}

static uint64_t unsigned_argument(va_list *args, int size) {
    switch (size) {
    case 1:
        return va_arg(*args, unsigned long);
    case 2:
        return va_arg(*args, unsigned long long);
    case 3:
        return va_arg(*args, size_t);
    default:
        return va_arg(*args, unsigned);
    }
}

static uint64_t narrowed(uint64_t number, int size) {
    return size == -1 ? (uint16_t)number : size == -2 ? (uint8_t)number : number;
}

static void put_integer(sink_t *sink, const field_t *field, char letter, va_list *args) {
    char text[INTEGER_SIZE + 1];
    char *digits = text;
    uint64_t magnitude;
    if (letter == 'd' || letter == 'i') {
        int64_t number = signed_argument(args, field->size);
        number = field->size == -1 ? (int16_t)number : field->size == -2 ? (int8_t)number : number;
        magnitude = number < 0 ? 0 - (uint64_t)number : (uint64_t)number;
        if (number < 0 || field->plus != 0) {
            *digits++ = number < 0 ? '-' : field->plus;
        }
    } else {
        magnitude = narrowed(unsigned_argument(args, field->size), field->size);
    }
    int width = field->precision < INTEGER_SIZE - 4 ? field->precision : INTEGER_SIZE - 4;
    bool hexadecimal = letter == 'x' || letter == 'X';
    size_t length =
        num_text_unsigned(digits, magnitude, hexadecimal ? 16 : 10, width > 0 ? (size_t)width : 0);
    for (size_t i = 0; letter == 'x' && i < length; i++) {
        digits[i] = (char)(digits[i] >= 'A' ? digits[i] + 0x20 : digits[i]);
    }
    put_field(sink, field, text, length + (size_t)(digits - text),
              field->zeros && field->precision < 0);
}

static void put_double(sink_t *sink, const field_t *field, char letter, double number) {
    char text[NUM_TEXT_SIZE + 1];
    char *digits = text;
    int precision = field->precision < 0 ? PRECISION_DEFAULT : field->precision;
    if (field->plus != 0 && !signbit(number)) {
        *digits++ = field->plus;
    }
    size_t length = letter == 'f'   ? num_text_fixed(digits, number, precision)
                    : letter == 'e' ? num_text_exponent(digits, number, precision)
                                    : num_text_general(digits, number, precision);
    put_field(sink, field, text, length + (size_t)(digits - text),
              field->zeros && isfinite(number));
}

static void put_string(sink_t *sink, const field_t *field, const char *text) {
    size_t most = field->precision < 0 ? SIZE_MAX : (size_t)field->precision;
    size_t length = 0;
    while (length < most && text[length] != '\0') {
        length++;
    }
    put_field(sink, field, text, length, false);
}

// True if the letter is one of ours.
static bool convert(sink_t *sink, const field_t *field, char letter, va_list *args) {
    char c;
    switch (letter) {
    case 'd':
    case 'i':
    case 'u':
    case 'x':
    case 'X':
        put_integer(sink, field, letter, args);
        return true;
    case 'f':
    case 'e':
    case 'g':
        put_double(sink, field, letter, va_arg(*args, double));
        return true;
    case 's':
        put_string(sink, field, va_arg(*args, const char *));
        return true;
    case 'c':
        c = (char)va_arg(*args, int);
        put_field(sink, field, &c, 1, false);
        return true;
    case '%':
        put(sink, '%');
        return true;
    default:
        return false;
    }
}

// ---- Face ---------------------------------------------------------------------------------------

size_t format_list(char *buffer, size_t size, const char *format, va_list args) {
    sink_t sink = {buffer, size, 0};
    va_list left; // an array on some machines, which cannot be handed on by its address
    va_copy(left, args);
    for (const char *p = format; *p != '\0'; p++) {
        field_t field;
        if (*p != '%') {
            put(&sink, *p);
            continue;
        }
        const char *letter = read_field(p + 1, &left, &field);
        if (convert(&sink, &field, *letter, &left)) {
            p = letter;
        } else {
            put(&sink, *p);
        }
    }
    va_end(left);
    if (size > 0) {
        buffer[sink.length < size ? sink.length : size - 1] = '\0';
    }
    return sink.length;
}

size_t format_text(char *buffer, size_t size, const char *format, ...) {
    va_list args;
    va_start(args, format);
    size_t length = format_list(buffer, size, format, args);
    va_end(args);
    return length;
}
