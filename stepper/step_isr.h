// The tick: executes segments, at most one step of each axis in a tick. Inside stepper/ only.
#ifndef STEPPER_STEP_ISR_H
#define STEPPER_STEP_ISR_H

#include "stepper/segment.h"

// Starts afresh with an empty ring. The tick will stop the machine when a pin of `trip_mask` has
// the level that `trip_levels` has for it. While there is such a pin the tick goes on when there is
// nothing to execute; otherwise it stops by itself. Context: main, while the tick is stopped.
void step_isr_setup(uint32_t trip_mask, uint32_t trip_levels);

// The step pin of each axis as a mask, 0 for none. Context: main, while nothing moves.
void step_isr_set_pins(const uint32_t masks[AXIS_COUNT]);

// Where the level of each segment goes. Context: main, while nothing moves.
void step_isr_set_pwm(hal_pwm_place_t place);

// No further step from now on: stops the tick, lowers the step pins, empties the ring.
// Contexts: main with the governor locked, governor.
void step_isr_abort(void);

// Where the motors are; false if the ring is empty, then the end of the last segment holds.
// Contexts: main with the governor locked, governor.
bool step_isr_position(int32_t steps[AXIS_COUNT]);

// A safety input has stopped the machine, and the tick with it. Until step_isr_rearm(). Any
// context.
bool step_isr_tripped(void);
void step_isr_rearm(void);

// There are safety inputs to watch. Any context.
bool step_isr_watches(void);

// Times the ring ran dry in the middle of a motion. Any context.
uint32_t step_isr_dry_count(void);

#endif
