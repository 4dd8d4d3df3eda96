// Sorting in place. Context: main loop.
#ifndef BASIC_SORT_H
#define BASIC_SORT_H

#include <stdbool.h>
#include <stdint.h>

#include "variables.h"

typedef struct {
    const variables_array_t *array; // numbers or strings
    const variables_array_t *index; // integers that change places with the elements; NULL: none
    uint32_t first;                 // element to start with, in the order of memory
    uint32_t count;
    bool descending;
    bool ignore_case;
    bool empty_last; // empty strings come behind all others
} sort_t;

// Sorts. The background goes on meanwhile; Ctrl-C ends it with the elements in some order, none
// lost.
void sort_run(const sort_t *job);

#endif
