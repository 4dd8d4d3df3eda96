// What the motors of the machine under test do, read off the edges of its pins.
#ifndef WATCH_H
#define WATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "stepper/stepper.h"

// Starts watching the pins of these axes; once in a process.
void watch_attach(const stepper_axis_t axes[AXIS_COUNT]);

// Forgets all steps; every motor stands at zero.
void watch_reset(void);

// The machine was told that it stands here. Steps that were made stay in the record.
void watch_set_position(const int32_t steps[AXIS_COUNT]);

void watch_position(int32_t steps[AXIS_COUNT]);
uint64_t watch_pulses(axis_id_t axis); // in both directions

// One for each pulse.
typedef struct {
    uint32_t tick; // since watch_reset(), in periods of 10 us
    int32_t place; // sum of all steps so far, whatever position was set meanwhile
} watch_step_t;

const watch_step_t *watch_steps(axis_id_t axis);

// Time of the last step of any axis; 0: none yet.
uint64_t watch_last_step_ns(void);

// From now on the places that the motors pass are remembered; and whether this was one of them, all
// axes at the same moment.
void watch_mark(void);
bool watch_was_at(const int32_t steps[AXIS_COUNT]);

// What is wrong with the record as a whole; NULL: nothing. Steps at least two ticks apart, none in
// the tick of a change of direction or the next.
const char *watch_fault(void);

// By how much the axis is beyond a limit of its speed (order 1, units/s), acceleration (2,
// units/s^2) or jerk (3, units/s^3) since `from_ns`; 0: it keeps it. Judged over windows of some
// milliseconds from differences of places. `jump`: a corner may change the speed by that much at
// once, units/s.
double watch_excess(axis_id_t axis, unsigned order, double limit, double jump, uint64_t from_ns);

#endif
