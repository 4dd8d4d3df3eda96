// Capital and small letters of ASCII; all other bytes, those of UTF-8 too, stay what they are.
// Context: any.
#ifndef BASE_LETTERS_H
#define BASE_LETTERS_H

#include <stdbool.h>
#include <stddef.h>

static inline char letters_upper(char c) {
    return c >= 'a' && c <= 'z' ? (char)(c - 0x20) : c;
}

static inline char letters_lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c + 0x20) : c;
}

// True if `length` characters are the same but for their case.
static inline bool letters_same(const char *left, const char *right, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (letters_upper(left[i]) != letters_upper(right[i])) {
            return false;
        }
    }
    return true;
}

#endif
