// Limit switches: which pins, which are pressed, which of them trip. Inside stepper/ only.
// Context: main loop.
#ifndef STEPPER_LIMITS_H
#define STEPPER_LIMITS_H

#include "stepper/stepper_safety.h"

// None, nothing overridden, the filters as after INIT.
void limits_reset(void);

// Gives all pins back. At rest only.
void limits_release(void);

// The pins of `switches` (bit n: switch n), and the switches of `pins`.
uint32_t limits_pins(uint32_t switches);
uint32_t limits_switches(uint32_t pins);

// Those of the pins that are active high: the levels of pressed switches.
uint32_t limits_levels(void);

// The switches that are there.
uint32_t limits_assigned(void);

// From now on these do not trip, because a motion goes to them on purpose; 0: all trip again,
// except those that are pressed. Also the inputs' levels and filters are made known to the tick.
void limits_except(uint32_t switches);

// The machine has been armed: what is pressed is overridden.
void limits_override_pressed(void);

// Overridden switches that have been released for a while trip again. Call it often.
void limits_follow(void);

// The samples of a latch at a limit switch or probe.
uint32_t limits_latch_samples(void);

#endif
