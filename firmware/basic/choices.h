// The words of a BASIC_ARG_CHOICE: "X|Y|Z|A". Context: main loop.
#ifndef BASIC_CHOICES_H
#define BASIC_CHOICES_H

#include <stddef.h>

// Index of the word, or -1. Case does not matter.
int choices_find(const char *choices, const char *text, size_t length);

// Text and length of the `index`th word, which exists.
const char *choices_get(const char *choices, int index, size_t *length);

// "X, Y, Z, A"; cut at the end of the buffer.
void choices_list(const char *choices, char *buffer, size_t size);

#endif
