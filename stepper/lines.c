// Line numbers of queue entries. An entry has 16 bits for it: the distance from the beginning of a
// span of numbers, plus one. A number that does not fit the span begins a new one: after 65535
// lines, or when another file begins at line 1. Two spans are kept, which is enough for what waits
// in the queue unless somebody jumps about in the numbers; then the oldest entries have none.
// Context: main.
#include "stepper/lines.h"

#include <stdbool.h>

#include "stepper/planner.h"

#define SPAN_LINES 65535u // 0 stands for no number

typedef struct {
    uint32_t first; // number
    uint32_t entry; // published entries when it began
} number_span_t;

static struct {
    uint32_t number;
    number_span_t now, before;
} lines;

void lines_set(uint32_t number) {
    lines.number = number;
}

void lines_restart(void) {
    lines.now.entry = 0;
    lines.before = lines.now;
}

uint16_t lines_code(void) {
    if (lines.number == 0) {
        return 0;
    }
    uint32_t distance = lines.number - lines.now.first;
    if (distance >= SPAN_LINES) {
        lines.before = lines.now;
        lines.now = (number_span_t){.first = lines.number, .entry = blocks.ring.written};
        distance = 0;
    }
    return (uint16_t)(distance + 1);
}

// Counts of entries run freely; none in the ring is as much as half of them away from another.
static bool is_of(const number_span_t *span, uint32_t entry) {
    return entry - span->entry < UINT32_MAX / 2;
}

uint32_t lines_number(uint32_t entry, uint16_t code) {
    if (code == 0) {
        return 0;
    }
    if (is_of(&lines.now, entry)) {
        return lines.now.first + code - 1;
    }
    return is_of(&lines.before, entry) ? lines.before.first + code - 1 : 0;
}
