// Changes to axes that are configured already: tuning, drivers by hand, forgetting them. A further
// face of stepper/, beside stepper.h. Context: main loop.
#ifndef STEPPER_AXES_H
#define STEPPER_AXES_H

#include "stepper/stepper.h"

// Gives a configured axis another scale, speed, acceleration, direction or backoff at once; pins,
// drivers and soft limits (in mm) stay as they are. The motor has not moved: with another scale its
// steps mean another place, so the position counts as unknown. Errors: axis not configured, moving
// or queued; nothing has changed then.
err_t stepper_tune(axis_id_t axis, const stepper_axis_t *config);

// Turns the drivers of `axes` (bit 0: X) on or off. Errors: none of them has an enable pin; moving
// or queued; on while E-STOP is asserted; off while armed.
err_t stepper_enable(uint32_t axes, bool on);

// Arc tolerance in mm, > 0; for what is queued from now on.
err_t stepper_arc_tolerance(double tolerance_mm);

// Forgets all axes, pins and settings as INIT does, but stays initialised, with the E-STOP input.
// Errors: moving or queued.
err_t stepper_reset(void);

#endif
