// Heap sort: no memory of its own, and no order of the elements makes it slow. Context: main loop.
#include "sort.h"

#include <string.h>

#include "console.h"
#include "errors.h"

#define ATTEND_EVERY 64 // comparisons

static uint8_t *place_of(const variables_array_t *array, uint32_t index) {
    return array->elements + (size_t)index * variables_element_size(array);
}

static int compare_ignoring_case(const value_t *left, const value_t *right) {
    for (uint32_t i = 0; i < left->length && i < right->length; i++) {
        int order = (uint8_t)letters_upper(left->text[i]) - (uint8_t)letters_upper(right->text[i]);
        if (order != 0) {
            return order;
        }
    }
    return (left->length > right->length) - (left->length < right->length);
}

static int compare_numbers(const value_t *left, const value_t *right) {
    if (left->type == VALUE_INTEGER) {
        return (left->integer > right->integer) - (left->integer < right->integer);
    }
    return (left->number > right->number) - (left->number < right->number);
}

// <0, 0, >0 for the order the job wants.
static int compare(const sort_t *job, uint32_t left_index, uint32_t right_index) {
    value_t left, right;
    variables_nth(job->array, left_index, &left);
    variables_nth(job->array, right_index, &right);
    value_fetch(&left);
    value_fetch(&right);
    int order;
    if (left.type != VALUE_STRING) {
        order = compare_numbers(&left, &right);
    } else if (job->empty_last && (left.length == 0 || right.length == 0)) {
        return (left.length == 0) - (right.length == 0);
    } else if (job->ignore_case) {
        order = compare_ignoring_case(&left, &right);
    } else {
        order = value_compare_text(&left, &right);
    }
    return job->descending ? -order : order;
}

static void swap_bytes(uint8_t *one, uint8_t *other, unsigned size) {
    while (size-- > 0) {
        uint8_t byte = *one;
        *one++ = *other;
        *other++ = byte;
    }
}

static void swap(const sort_t *job, uint32_t one, uint32_t other) {
    swap_bytes(place_of(job->array, one), place_of(job->array, other),
               variables_element_size(job->array));
    if (job->index != NULL) {
        swap_bytes(place_of(job->index, one), place_of(job->index, other),
                   variables_element_size(job->index));
    }
}

static void attend(void) {
    static unsigned countdown = ATTEND_EVERY;
    if (--countdown == 0) {
        countdown = ATTEND_EVERY;
        console_background();
        console_poll();
        if (console_break_pending()) {
            errors_break();
        }
    }
}

// Lets element `root` of the heap of the first `count` elements sink to its place.
static void sink(const sort_t *job, uint32_t root, uint32_t count) {
    for (;;) {
        uint32_t child = 2 * root + 1;
        if (child >= count) {
            return;
        }
        attend();
        if (child + 1 < count && compare(job, job->first + child, job->first + child + 1) < 0) {
            child++;
        }
        if (compare(job, job->first + root, job->first + child) >= 0) {
            return;
        }
        swap(job, job->first + root, job->first + child);
        root = child;
    }
}

void sort_run(const sort_t *job) {
    for (uint32_t root = job->count / 2; root-- > 0;) {
        sink(job, root, job->count);
    }
    for (uint32_t last = job->count; last-- > 1;) {
        swap(job, job->first, job->first + last);
        sink(job, 0, last);
    }
}
