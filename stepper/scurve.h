// The speed profile with a limit of the jerk. Inside stepper/ only. Context: governor.
#ifndef STEPPER_SCURVE_H
#define STEPPER_SCURVE_H

#include "stepper/profile.h"

// An acceleration is meant to hold for this long. Shorter follows the limits more closely, and
// costs more.
#define SCURVE_TICKS 200.0f

// The acceleration for the next SCURVE_TICKS. now->acceleration is the one that ends here, after
// `elapsed_s`.
float scurve_acceleration(const profile_t *now, float elapsed_s);

// Whether the last choice was to go on at the top speed, with nothing ahead that matters within
// SCURVE_QUIET_TICKS: it may hold that long.
#define SCURVE_QUIET_TICKS 500.0f
bool scurve_is_quiet(void);

// The speed after `dt` seconds of it.
float scurve_speed(float speed, float acceleration, float dt);

#endif
