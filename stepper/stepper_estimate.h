// How long motion will take, without moving: the entries of a program one after the other, planned
// as the machine is configured now. A further face of stepper/. Context: main loop; it touches
// nothing of the machine.
//
// It looks as many moves ahead as a small queue does. Trapezoids are as the motors will make them;
// what a jerk limit adds is estimated.
#ifndef STEPPER_ESTIMATE_H
#define STEPPER_ESTIMATE_H

#include "stepper/stepper.h"

#define STEPPER_ESTIMATE_MOVES 28u // that are looked ahead

// Belongs to the caller; what it holds is private.
typedef struct {
    uint64_t store[88];
} stepper_estimate_t;

// Begins at rest at `position`.
void stepper_estimate_start(stepper_estimate_t *estimate, const double position[AXIS_COUNT]);

// From the end of the move before. All axes that move are configured.
void stepper_estimate_line(stepper_estimate_t *estimate, const stepper_move_t *move);

// The same for an arc, with how far each axis goes on its way. Errors: those of stepper_arc() that
// have to do with its shape.
err_t stepper_estimate_arc(stepper_estimate_t *estimate, const stepper_arc_t *arc,
                           double low[AXIS_COUNT], double high[AXIS_COUNT]);

// Motion comes to a standstill here for so long, 0 too.
void stepper_estimate_pause(stepper_estimate_t *estimate, double seconds);

// The machine stands elsewhere all of a sudden (homing, probing).
void stepper_estimate_place(stepper_estimate_t *estimate, const double position[AXIS_COUNT]);

// Seconds of all that came so far, with the stop at its end.
double stepper_estimate_seconds(stepper_estimate_t *estimate);

#endif
