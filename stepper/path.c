// The way of a move that is being executed. Context: governor.
#include "stepper/path.h"

#include <string.h>

#include "stepper/segment.h"

static struct {
    block_kind_t kind;
    int32_t from[AXIS_COUNT]; // steps, where the move before it ends as programmed
    int32_t to[AXIS_COUNT];   // and this one
} path;

void path_stand(const int32_t steps[AXIS_COUNT]) {
    path.kind = BLOCK_DWELL;
    memcpy(path.to, steps, sizeof path.to);
}

void path_begin(const block_t *block) {
    path.kind = block->kind;
    memcpy(path.from, path.to, sizeof path.from);
    memcpy(path.to, block->move.target, sizeof path.to);
}

void path_at(uint64_t progress, int64_t position[AXIS_COUNT]) {
    uint32_t fraction = (uint32_t)(progress >> 32);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t delta = (int64_t)path.to[axis] - path.from[axis];
        position[axis] = path.from[axis] * STEP_ONE + delta * fraction;
    }
}

void path_end(int64_t position[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        position[axis] = path.to[axis] * STEP_ONE;
    }
}
