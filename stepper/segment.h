// The segment ring: what the governor hands to the tick. Inside stepper/ only.
// A segment is some ticks of constant speed for each axis. The governor writes, the tick reads.
#ifndef STEPPER_SEGMENT_H
#define STEPPER_SEGMENT_H

#include "stepper/stepper.h"

#define SEGMENTS 64u

// Exact positions count in 2^-32 of a step.
#define STEP_ONE ((int64_t)1 << 32)

// Phase and rate are fractions of a step in 2^-32. Each tick adds the rate to the phase; a carry is a
// step. The tick takes the axes two at a time, hence the order in memory: phases of X and Y, rates of
// X and Y, then Z and A.
typedef struct {
    struct {
        uint32_t phase[2];
        uint32_t rate[2]; // at most 2^31: one step in two ticks
    } pair[2];
    uint32_t ticks;    // >= 1
    uint32_t pins_set; // driven at the segment's first tick: direction, spindle, enable
    uint32_t pins_clear;
    uint32_t end_ticks;              // ticks of all segments up to the end of this one, modulo 2^32
    uint32_t flags;                  // bit n: axis n counts down; SEGMENT_MAY_END
    int32_t start_steps[AXIS_COUNT]; // motor position before the first tick
} segment_t;

#define SEGMENT_MAY_END (1u << 31) // the machine stands at its end; the ring may be empty behind it

typedef struct {
    ring_t ring;
    segment_t slots[SEGMENTS];
} segment_ring_t;

extern segment_ring_t segments;

static inline uint32_t *segment_phase(segment_t *segment, axis_id_t axis) {
    return &segment->pair[axis >> 1].phase[axis & 1];
}

static inline uint32_t *segment_rate(segment_t *segment, axis_id_t axis) {
    return &segment->pair[axis >> 1].rate[axis & 1];
}

#endif
