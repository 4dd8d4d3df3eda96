// Jerk-limited changes of speed: closed forms. Inside stepper/ only. Context: any, pure functions.
//
// Speeds along the path, v in units/s, a in units/s^2, at constant jerk in three phases at most:
// the acceleration is built up, kept, and taken back.
#ifndef STEPPER_RAMP_H
#define STEPPER_RAMP_H

typedef struct {
    float acceleration, jerk;
    float per_acceleration, per_jerk; // 1 / them
    float build_up_s;                 // acceleration / jerk
    float full_change;                // speed change that just reaches the full acceleration
} ramp_t;

void ramp_set(ramp_t *ramp, float acceleration, float jerk);

// The way from speed v to the lower speed w, both without acceleration.
float ramp_distance(const ramp_t *ramp, float v, float w);

// The way from speed v with acceleration a until speed w is reached and a taken back, braking as
// soon as the jerk allows. 0 if that never exceeds w.
float ramp_braking_distance(const ramp_t *ramp, float v, float a, float w);

// The acceleration with which speed v comes to `top` as fast as possible, if it is kept for `time`
// s and can then still be taken back without passing `top`.
float ramp_towards(const ramp_t *ramp, float v, float top, float time);

#endif
