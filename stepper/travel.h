// Along the moves of the block ring: time becomes way, and way becomes segments. Inside stepper/
// only. Context: governor, or main with the governor locked.
#ifndef STEPPER_TRAVEL_H
#define STEPPER_TRAVEL_H

#include "stepper/planner.h"

// At rest, on no block; what was under way is forgotten.
void travel_stand(void);

// Goes along the front block, which planner_start() was called for, from a standstill.
void travel_begin(const block_t *block);

typedef enum {
    TRAVEL_GOES_ON,
    TRAVEL_ARRIVED, // at rest at the end of a block, which is released
    TRAVEL_STOPPED, // at rest within a block
} travel_t;

// One slice of `ticks`, through as many blocks as it touches and the segment ring has room for;
// blocks that it leaves are released. `braking`: to a standstill as soon as the limits allow.
travel_t travel_advance(float ticks, bool braking);

// Something has changed: a jerk limit should not wait until its last choice is over.
void travel_choose_again(void);

// Speed along the path, units/s, and what is left of the block, units; 0 if there is none.
float travel_speed(void);
float travel_left(void);

#endif
