// The segment ring: what the governor hands to the tick. Inside stepper/ only. A segment is some
// ticks in which the speed of each axis changes evenly. The governor writes, the tick reads.
#ifndef STEPPER_SEGMENT_H
#define STEPPER_SEGMENT_H

#include "stepper/stepper.h"

#define SEGMENTS 32u

// Exact positions count in 2^-32 of a step.
#define STEP_ONE ((int64_t)1 << 32)

// Fractions of a step in 2^-32. Each tick adds the rate to the phase, where a carry is a step, and
// then the ramp to the rate: at the ticks the axis is exactly on a parabola.
typedef struct {
    uint32_t phase;
    uint32_t rate;       // in every tick at most RATE_MAX
    uint32_t ramp;       // two's complement
    int32_t start_steps; // motor position before the first tick
} segment_axis_t;

#define RATE_MAX ((uint32_t)1 << 31) // a step in every second tick

typedef struct {
    segment_axis_t axes[AXIS_COUNT];
    uint32_t ticks;    // >= 1
    uint32_t pins_set; // driven at the segment's first tick: direction, spindle, enable
    uint32_t pins_clear;
    uint32_t end_ticks; // ticks of all segments up to the end of this one, modulo 2^32
    uint32_t flags;     // bit n: axis n counts down; SEGMENT_MAY_END; upper half: PWM level
} segment_t;

#define SEGMENT_MAY_END (1u << 8) // the machine stands at its end; the ring may be empty behind it
#define SEGMENT_LEVEL_SHIFT 16

typedef struct {
    ring_t ring;
    segment_t slots[SEGMENTS];
} segment_ring_t;

extern segment_ring_t segments; // in step_isr.c

// Motor position at `wanted` ticks before the end of the segment, which the tick has carried out up
// to `left` before the end; and at its beginning. Contexts: governor, main with the governor
// locked.
void segment_position(const segment_t *segment, uint32_t left, uint32_t wanted,
                      int32_t steps[AXIS_COUNT]);
void segment_start(const segment_t *segment, int32_t steps[AXIS_COUNT]);

#endif
