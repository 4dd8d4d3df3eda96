// The speed profile with a limit of the jerk. Inside stepper/ only. Context: governor.
#ifndef STEPPER_SCURVE_H
#define STEPPER_SCURVE_H

#include "stepper/profile.h"

// An acceleration holds for this long. Shorter follows the limits more closely, and costs more.
#define SCURVE_TICKS 200u

// The acceleration for the next SCURVE_TICKS. now->acceleration is the one that ends here.
float scurve_acceleration(const profile_t *now);

// The speed after `dt` seconds of it.
float scurve_speed(float speed, float acceleration, float dt);

#endif
