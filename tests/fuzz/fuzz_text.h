// A piece of input under construction, and what generators put into it.
#ifndef FUZZ_TEXT_H
#define FUZZ_TEXT_H

#include <stddef.h>

#define FUZZ_TEXT_MAX 12000 // bytes; more is dropped

typedef struct {
    size_t length;
    char bytes[FUZZ_TEXT_MAX];
} fuzz_text_t;

void fuzz_text_clear(fuzz_text_t *text);
void fuzz_text_byte(fuzz_text_t *text, char byte);
void fuzz_text_add(fuzz_text_t *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// A number as people and programs write it, more often than not an awkward one: at the edge of a
// type, far too long, with signs, points and exponents in odd places.
void fuzz_text_number(fuzz_text_t *text);

// `count` random bytes: anything, or printable ones only.
void fuzz_text_noise(fuzz_text_t *text, size_t count);
void fuzz_text_printable(fuzz_text_t *text, size_t count);

// Spoils what is there in a few places: bytes changed, left out, doubled or swapped, pieces moved.
void fuzz_text_mutate(fuzz_text_t *text);

#endif
