// Jogging: one axis moved by hand towards a target that may change on the way. Inside stepper/
// only. A motion of its own beside the block ring, which is empty meanwhile.
#ifndef STEPPER_JOG_H
#define STEPPER_JOG_H

#include "stepper/stepper.h"

typedef struct {
    axis_id_t axis;
    int32_t target;     // steps
    float units;        // per step
    float speed;        // units/s
    float acceleration; // units/s^2
    float jerk;         // units/s^3, 0: trapezoid
} jog_request_t;

// Goes to this target from now on. If another axis is moving it comes to a standstill first. The
// machine stands, or jogs. Context: main with the governor locked.
void jog_start(const jog_request_t *request);

// Brake to a standstill and stay there. Contexts: main with the governor locked, governor.
void jog_stop(void);

// No further motion. Context: as jog_stop().
void jog_drop(void);

// A jog is under way. Any context.
bool jog_active(void);

float jog_speed(void); // units/s. Any context

// One more slice. Context: governor.
void jog_advance(void);

#endif
