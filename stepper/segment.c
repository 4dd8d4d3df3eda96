// Where the motors are in a segment. Contexts: governor, main with the governor locked.
#include "stepper/segment.h"

// Phase and rate at the start follow from those now, and the carries from there on from 64-bit
// arithmetic.
void segment_position(const segment_t *segment, uint32_t left, uint32_t wanted,
                      int32_t steps[AXIS_COUNT]) {
    uint64_t done = segment->ticks - left;
    uint64_t ramps = done * (done - 1) / 2; // 0 + 1 + ... + (done - 1): how often each ramp counts
    uint64_t until = segment->ticks - wanted;
    uint64_t ramps_until = until * (until - 1) / 2;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        const segment_axis_t *now = &segment->axes[axis];
        uint64_t ramp = (uint64_t)(int32_t)now->ramp;
        uint32_t start_rate = now->rate - now->ramp * (uint32_t)done;
        uint32_t start_phase = now->phase - (uint32_t)(start_rate * done + ramp * ramps);
        uint64_t travel = start_rate * until + ramp * ramps_until;
        int32_t carries = (int32_t)((start_phase + travel) >> 32);
        bool negative = (segment->flags >> axis) & 1;
        steps[axis] = now->start_steps + (negative ? -carries : carries);
    }
}

void segment_start(const segment_t *segment, int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = segment->axes[axis].start_steps;
    }
}
