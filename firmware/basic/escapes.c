// Escapes in strings. Context: main loop, while compiling.
#include "escapes.h"

#include <string.h>

#include "errors.h"

#define DECIMAL_DIGITS 3
#define HEX_DIGITS 2
#define BYTE_MAX 255u

static int digit_value(char c, unsigned base) {
    int value = -1;
    if (c >= '0' && c <= '9') {
        value = c - '0';
    } else if ((c | 0x20) >= 'a' && (c | 0x20) <= 'f') {
        value = (c | 0x20) - 'a' + 10;
    }
    return value < (int)base ? value : -1;
}

static _Noreturn void fail(const char *from, const char *end) {
    int shown = end - from < DECIMAL_DIGITS ? (int)(end - from) : DECIMAL_DIGITS;
    errors_fail_with(ERR_BAD_ESCAPE, "%.*s", shown, from);
}

// Exactly `count` digits of a byte's value from `digits` on; `from` is what an error shows.
static char read_code(const char *from, const char *digits, const char *end, unsigned base,
                      int count) {
    unsigned code = 0;
    for (int i = 0; i < count; i++) {
        int value = digits + i < end ? digit_value(digits[i], base) : -1;
        if (value < 0) {
            fail(from, end);
        }
        code = code * base + (unsigned)value;
    }
    if (code > BYTE_MAX) {
        fail(from, end);
    }
    return (char)code;
}

// What follows the backslash. Returns the place behind.
static const char *replace_one(char *to, const char *from, const char *end) {
    static const char names[] = "abefnqrtv\\\"'";
    static const char bytes[] = "\a\b\x1b\f\n\"\r\t\v\\\"'";
    const char *name =
        from < end ? strchr(names, *from | (*from >= 'A' && *from <= 'Z' ? 0x20 : 0)) : NULL;
    if (name != NULL && *name != '\0') {
        *to = bytes[name - names];
        return from + 1;
    }
    if (from < end && ((*from | 0x20) == 'x' || *from == '&')) {
        *to = read_code(from, from + 1, end, 16, HEX_DIGITS);
        return from + 1 + HEX_DIGITS;
    }
    *to = read_code(from, from, end, 10, DECIMAL_DIGITS);
    return from + DECIMAL_DIGITS;
}

size_t escapes_replace(char *to, const char *from, size_t length) {
    const char *end = from + length;
    size_t used = 0;
    while (from < end) {
        if (*from == '\\') {
            from = replace_one(&to[used++], from + 1, end);
        } else {
            to[used++] = *from++;
        }
    }
    return used;
}
