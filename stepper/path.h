// The way of a move that is being executed: from the fraction of its length to exact positions.
// Inside stepper/ only. Context: governor.
#ifndef STEPPER_PATH_H
#define STEPPER_PATH_H

#include "stepper/planner.h"

// Follows `block` next, the front of the ring, behind the one that path_begin() was called with
// before.
void path_begin(const block_t *block);

// Stands at `steps`; the next path begins there.
void path_stand(const int32_t steps[AXIS_COUNT]);

// Position in 2^-32 steps at `progress` in 2^-64 of the length; path_end: at its end.
void path_at(uint64_t progress, int64_t position[AXIS_COUNT]);
void path_end(int64_t position[AXIS_COUNT]);

#endif
