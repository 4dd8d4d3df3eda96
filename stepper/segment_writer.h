// Writes segments: from positions and times to phases and rates. Inside stepper/ only.
// Context: governor, or main with the governor locked.
#ifndef STEPPER_SEGMENT_WRITER_H
#define STEPPER_SEGMENT_WRITER_H

#include "stepper/segment.h"

// Stands at `steps`, with the direction pins as they are; the ring is empty.
void segment_writer_reset(const int32_t steps[AXIS_COUNT]);

// Takes these direction pins and sets them all to up. At rest only. `inverted`: bit n set if the
// direction pin of axis n is low when it counts up.
void segment_writer_set_dir_pins(const uint32_t dir[AXIS_COUNT], uint32_t inverted);

// The PWM has this level in segments written from now on; and what it is.
void segment_writer_set_level(uint16_t level);
uint16_t segment_writer_level(void);

// Goes to `target` (2^-32 steps) within `ticks` (less than 2^14). The segment ends at the last
// whole tick in that time; what is left of time and way is the next call's, all of it if it is less
// than a tick. `change`: how the speed along the path changes on the way, (end - start) / (end +
// start) in SEGMENT_CHANGE_ONE, at most 1. `at_rest`: the motion ends there, and now.
#define SEGMENT_CHANGE_ONE ((int32_t)1 << 30)
static inline int32_t segment_writer_change(float start, float end) {
    float rise = end - start;
    return rise != 0.0f ? (int32_t)(rise / (start + end) * (float)SEGMENT_CHANGE_ONE) : 0;
}

void segment_writer_move(const int64_t target[AXIS_COUNT], float ticks, int32_t change,
                         bool at_rest);

// Stands still for `ticks` (>= 1); the pins are switched at the first one.
void segment_writer_wait(uint32_t ticks, uint32_t pins_set, uint32_t pins_clear);

// Shows the tick what was written since the last call.
void segment_writer_publish(void);

// Motor positions at the end of the last segment.
void segment_writer_end_steps(int32_t steps[AXIS_COUNT]);

// Takes the motor position as the exact position, after a stop between two steps.
void segment_writer_settle(void);

// Ticks behind the segment that the tick is at, and those of that one; room for what one call of
// the functions above can write.
uint32_t segment_writer_spare_ticks(void);
uint32_t segment_writer_oldest_ticks(void);
bool segment_writer_has_room(void);

#endif
