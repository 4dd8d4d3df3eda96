// STR$ and FORMAT$: numbers laid out as the program wants. Context: main loop.
#include <string.h>

#include "errors.h"
#include "functions.h"
#include "memory.h"
#include "number_text.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)
#define FORMAT_PRECISION 4
#define WIDTH_MAX 128

static int limited(int64_t value, int least, int most) {
    if (value < least || value > most) {
        errors_fail_with(ERR_ARGUMENT, "%lld is invalid (valid is %d to %d)", (long long)value,
                         least, most);
    }
    return (int)value;
}

static char *new_text(size_t length) {
    if (length > VALUE_STRING_MAX) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    return memory_text(length);
}

static void set_copy(value_t *result, const char *text, size_t length) {
    char *copy = new_text(length);
    memcpy(copy, text, length);
    value_set_text(result, copy, length);
}

// The number without a sign of its own in front when positive; with decimals as STR$ wants them.
static size_t number_for_str(char *text, value_t *number, bool has_decimals, int decimals) {
    if (!has_decimals) {
        return number_text_value(text, number);
    }
    if (decimals < 0) {
        return num_text_exponent(text, value_to_number(number), -decimals);
    }
    if (number->type == VALUE_INTEGER && decimals == 0) {
        return num_text_integer(text, number->integer);
    }
    return num_text_fixed(text, value_to_number(number), decimals);
}

FUNCTION(str) {
    int width = count > 1 ? limited(arguments[1].integer, -WIDTH_MAX, WIDTH_MAX) : 0;
    int decimals = count > 2 ? limited(arguments[2].integer, -16, 16) : 0;
    char filler = count > 3 && arguments[3].length > 0 ? arguments[3].text[0] : ' ';
    bool show_sign = width < 0;
    width = width < 0 ? -width : width;

    char digits[NUMBER_TEXT_SIZE];
    size_t length = number_for_str(digits, arguments, count > 2, decimals);
    bool negative = digits[0] == '-';
    const char *shown = digits + negative;
    length -= negative;
    size_t whole = strcspn(shown, ".e");
    bool has_sign = negative || show_sign;
    size_t fill = (size_t)width > whole + has_sign ? (size_t)width - whole - has_sign : 0;

    char text[NUMBER_TEXT_SIZE + WIDTH_MAX];
    size_t used = 0;
    char sign = negative ? '-' : '+';
    if (has_sign && filler == '0') { // a sign goes before zeros, but behind blanks
        text[used++] = sign;
    }
    memset(text + used, filler, fill);
    used += fill;
    if (has_sign && filler != '0') {
        text[used++] = sign;
    }
    memcpy(text + used, shown, length);
    set_copy(result, text, used + length);
}

typedef struct {
    bool left, plus, blank, zeros;
    int width, precision;
    char letter;             // g, f or e
    bool capital;            // it was G or E, and so is the E of the number
    const char *start, *end; // of the specification in the format
} specification_t;

static const char *read_count(const char *p, const char *end, int *count) {
    for (*count = 0; p < end && *p >= '0' && *p <= '9'; p++) {
        *count = limited(*count * 10 + (*p - '0'), 0, WIDTH_MAX);
    }
    return p;
}

static void read_specification(const value_t *format, specification_t *out) {
    const char *end = format->text + format->length;
    const char *p = memchr(format->text, '%', format->length);
    *out = (specification_t){.precision = FORMAT_PRECISION};
    if (p == NULL) {
        errors_fail(ERR_SYNTAX);
    }
    out->start = p++;
    for (; p < end && strchr("-+ 0", *p) != NULL && *p != '\0'; p++) {
        out->left |= *p == '-';
        out->plus |= *p == '+';
        out->blank |= *p == ' ';
        out->zeros |= *p == '0';
    }
    p = read_count(p, end, &out->width);
    if (p < end && *p == '.') {
        p = read_count(p + 1, end, &out->precision);
    }
    out->letter = p < end ? (char)(*p | 0x20) : '\0';
    out->capital = p < end && *p < 'a';
    if (strchr("gfe", out->letter) == NULL || out->letter == '\0') {
        errors_fail(ERR_SYNTAX);
    }
    out->end = p + 1;
}

static size_t format_number(char *text, const specification_t *how, double number) {
    switch (how->letter) {
    case 'f':
        return num_text_fixed(text, number, how->precision);
    case 'e':
        return num_text_exponent(text, number, how->precision);
    default:
        return num_text_general(text, number, how->precision == 0 ? 1 : how->precision);
    }
}

// Appends the number as specified.
static size_t lay_out(char *out, const specification_t *how, double number) {
    char digits[NUMBER_TEXT_SIZE];
    size_t length = format_number(digits, how, number);
    bool negative = digits[0] == '-';
    const char *shown = digits + negative;
    length -= negative;
    char sign = negative ? '-' : how->plus ? '+' : how->blank ? ' ' : '\0';
    size_t total = length + (sign != '\0');
    size_t fill = (size_t)how->width > total ? (size_t)how->width - total : 0;
    char *p = out;
    if (!how->left && !how->zeros) {
        memset(p, ' ', fill);
        p += fill;
    }
    if (sign != '\0') {
        *p++ = sign;
    }
    if (!how->left && how->zeros) {
        memset(p, '0', fill);
        p += fill;
    }
    for (size_t i = 0; i < length; i++) {
        *p++ = how->capital && shown[i] == 'e' ? 'E' : shown[i];
    }
    if (how->left) {
        memset(p, ' ', fill);
        p += fill;
    }
    return (size_t)(p - out);
}

FUNCTION(format) {
    value_t general;
    value_set_text(&general, "%g", 2);
    const value_t *format = count > 1 ? &arguments[1] : &general;
    specification_t how;
    read_specification(format, &how);
    char number[NUMBER_TEXT_SIZE + WIDTH_MAX];
    size_t length = lay_out(number, &how, arguments->number);
    size_t before = (size_t)(how.start - format->text);
    size_t after = format->length - (size_t)(how.end - format->text);
    char *text = new_text(before + length + after);
    memcpy(text, format->text, before);
    memcpy(text + before, number, length);
    memcpy(text + before + length, how.end, after);
    value_set_text(result, text, before + length + after);
}
