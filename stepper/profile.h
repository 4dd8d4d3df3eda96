// How fast the machine may be at the end of the next moment: the speed profile, with and without a
// limit of the jerk. Inside stepper/ only. Context: governor.
#ifndef STEPPER_PROFILE_H
#define STEPPER_PROFILE_H

#include "stepper/planner.h"

// Where the machine is in the profile of the front block.
typedef struct {
    const block_t *block;
    float left;         // units to its end
    float top;          // units/s, the most that is allowed in it; 0: brake to a standstill
    float speed;        // units/s now
    float acceleration; // units/s^2 that led here
} profile_t;

// The speed after the next `*ticks`, counted to the end of the block and beyond as if it went on.
// May lessen `*ticks` to where the acceleration changes. For blocks without a jerk limit.
float profile_next_speed(const profile_t *now, float *ticks);

// The most after the next `dt` seconds from which the acceleration alone can still brake to the
// exit speed; not less than braking gives.
float profile_braking_speed(const profile_t *now, float exit_speed2, float dt);

#endif
