// The places ahead that the speed has to be fit for, nearest first: what the planner keeps, as the
// S-curve reads it. Inside stepper/ only. Inline, because a curve of short moves has hundreds.
// Context: governor.
#ifndef STEPPER_BOUNDS_H
#define STEPPER_BOUNDS_H

#include "stepper/planner.h"

// A place ahead that must not be passed faster than `cap`, and the limits between the one before
// and it: the binding entries behind the front block, one after the other, and at last the end of
// the queue, where the cap is 0.
typedef struct {
    uint32_t way;
    v2_t cap;
    span_t span;
    uint32_t index, more; // for bounds_next()
} bound_t;

static inline void bounds_first(bound_t *bound) {
    bound->index = blocks.binding.first;
    bound->more = blocks.binding.count + 1;
}

// The nearest one after bounds_first(), then the next. False: there are no more.
static inline bool bounds_next(bound_t *bound) {
    if (bound->more <= 1) {
        bound->way = blocks.end_way;
        bound->cap = 0;
        bound->span = blocks.end_span;
        return bound->more-- == 1;
    }
    uint32_t index = bound->index;
    const block_t *block = &blocks.slots[blocks.binding.slot[index]];
    bound->way = block->way;
    bound->cap = blocks.binding.cap[index];
    bound->span = (span_t){block->span_acceleration, block->span_jerk};
    bound->index = index + 1 < STEPPER_BLOCKS_MAX ? index + 1 : 0;
    bound->more--;
    return true;
}

// A curve made of short moves has hundreds of bounds. Passes over the next ones if a whole group of
// them has no cap below `cap` and no limit below `span`. Returns how many.
static inline uint32_t bounds_skip(bound_t *bound, v2_t cap, span_t span) {
    uint32_t group = bound->index / PLANNER_GROUP;
    if (bound->index % PLANNER_GROUP != 0 || bound->more <= PLANNER_GROUP + 1 ||
        blocks.binding.group_cap[group] < cap ||
        blocks.binding.group_span[group].acceleration < span.acceleration ||
        blocks.binding.group_span[group].jerk < span.jerk) {
        return 0;
    }
    bound->index = (bound->index + PLANNER_GROUP) % STEPPER_BLOCKS_MAX;
    bound->more -= PLANNER_GROUP;
    return PLANNER_GROUP;
}

#endif
