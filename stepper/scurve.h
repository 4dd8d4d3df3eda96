// The speed profile with a limit of the jerk. Inside stepper/ only. Context: governor.
#ifndef STEPPER_SCURVE_H
#define STEPPER_SCURVE_H

#include "stepper/profile.h"

// As profile_next_speed(), for blocks with a jerk limit.
float scurve_next_speed(profile_t *now, float ticks);

#endif
