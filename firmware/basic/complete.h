// What a word that has been begun at the prompt may become: commands, functions, names of the
// program, and files within a string. Context: main loop.
#ifndef BASIC_COMPLETE_H
#define BASIC_COMPLETE_H

#include <stdbool.h>
#include <stddef.h>

#include "basic/basic.h"

#define COMPLETE_MAX 64

typedef struct {
    size_t count;            // candidates
    size_t typed;            // bytes in front of the cursor that they all begin with
    char more[COMPLETE_MAX]; // what they all go on with, as it is to be put in
    size_t more_length;
} complete_t;

// For the `cursor` bytes at `line`.
void complete_find(const char *line, size_t cursor, complete_t *result);

// Prints the candidates side by side.
void complete_list(const char *line, size_t cursor);

#endif
