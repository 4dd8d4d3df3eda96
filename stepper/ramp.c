// Jerk-limited changes of speed. Context: any, pure functions.
//
// A change by D from rest of acceleration to rest of acceleration takes T = 2 sqrt(D / J) if that
// stays below the full acceleration A, that is D <= A^2 / J, and D / A + A / J otherwise. Its speed
// is symmetrical in time, so the way is the mean speed times T.
#include "stepper/ramp.h"

#include <math.h>

void ramp_set(ramp_t *ramp, float acceleration, float jerk) {
    ramp->acceleration = acceleration;
    ramp->jerk = jerk;
    ramp->per_acceleration = 1.0f / acceleration;
    ramp->per_jerk = 1.0f / jerk;
    ramp->build_up_s = acceleration * ramp->per_jerk;
    ramp->full_change = acceleration * ramp->build_up_s;
}

float ramp_distance(const ramp_t *ramp, float v, float w) {
    float change = v - w;
    float time = change < ramp->full_change ? 2.0f * sqrtf(change * ramp->per_jerk)
                                            : change * ramp->per_acceleration + ramp->build_up_s;
    return 0.5f * (v + w) * time;
}

float ramp_braking_distance(const ramp_t *ramp, float v, float a, float w) {
    float build_up = a * ramp->per_jerk; // s
    float taken_back = 0.5f * a * build_up;
    if (a > 0.0f) {
        float peak = v + taken_back;
        return peak > w ? build_up * (v + (2.0f / 3.0f) * taken_back) + ramp_distance(ramp, peak, w)
                        : 0.0f;
    }
    if (v <= w) {
        return 0.0f;
    }
    if (v - taken_back <= w) {
        // w is passed while the braking is taken back, after at most twice the time D / |a|, and
        // above w the speed falls at least like a parabola: 2/3 of the rectangle D by D / |a|.
        float change = v - w;
        return change * (2.0f * w + (2.0f / 3.0f) * change) / -a;
    }
    // As if braking had begun where the acceleration was 0, less the way since then.
    float start = v + taken_back;
    return ramp_distance(ramp, start, w) + build_up * (start - (1.0f / 3.0f) * taken_back);
}

// The acceleration a over `time` and then taken back gives v + a time + a^2 / 2J = top; downwards
// alike.
float ramp_towards(const ramp_t *ramp, float v, float top, float time) {
    float step = ramp->jerk * time;
    float change = top - v;
    float size = sqrtf(step * step + 2.0f * ramp->jerk * fabsf(change)) - step;
    return change < 0.0f ? -size : size;
}
