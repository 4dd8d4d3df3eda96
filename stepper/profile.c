// The speed profile without a limit of the jerk: three pieces, each known exactly.
//
//   speed |       _______________           accelerate until `top` or the braking curve,
//         |     .'               '.         cruise until the braking curve,
//         |___.'                   '.___    brake to what the planner allows at the block's end
//
// Context: governor.
#include "stepper/profile.h"

#include <math.h>

#include "stepper/extremes.h"
#define TICK_S (1.0f / (float)HAL_TICK_HZ)
// Pieces shorter than this are not worth a segment.
#define PIECE_TICKS_MIN 1.0f
// Braking may be that much harder to come back to the braking curve, which rounding has left.
#define BRAKING_SLACK 1.001f

// Solves v1^2 = exit^2 + 2 a (left - (v + v1) / 2 dt), so that braking which starts behind this
// slice still succeeds.
float profile_braking_speed(const profile_t *now, float exit_speed2, float dt) {
    float acceleration = now->block->move.acceleration;
    float change = acceleration * dt;
    float root2 = change * change +
                  4.0f * (exit_speed2 + 2.0f * acceleration * now->left - change * now->speed);
    float braking = root2 > 0.0f ? 0.5f * (sqrtf(root2) - change) : 0.0f;
    return greater(greater(braking, now->speed - change * BRAKING_SLACK), 0.0f);
}

// A slice in which the acceleration changes ends there, if both parts are worth a segment.
static bool split(float *ticks, float part_s) {
    float part = part_s * (float)HAL_TICK_HZ;
    if (part >= PIECE_TICKS_MIN && *ticks - part >= PIECE_TICKS_MIN) {
        *ticks = part;
        return true;
    }
    return false;
}

// v + change. Adding the same again and again rounds the same way each time, which in a long ramp
// would add up to an acceleration of its own: what was rounded off is made up for in the next
// slice.
static float faster(float v, float change) {
    static struct {
        float speed, rest;
    } last;
    float exact = last.speed == v ? change + last.rest : change;
    last.speed = v + exact;
    last.rest = exact - (last.speed - v);
    return last.speed;
}

float profile_next_speed(const profile_t *now, float *ticks) {
    float v = now->speed;
    float acceleration = now->block->move.acceleration;
    float dt = *ticks * TICK_S;
    float exit_speed2 = planner_exit_speed2();
    float v1 = v + acceleration * dt;
    if (v < now->top) {
        v1 = faster(v, acceleration * dt);
        // Where accelerating meets the braking curve.
        float peak2 = 0.5f * (v * v + exit_speed2) + acceleration * now->left;
        if (v1 <= now->top && v1 * v1 <= peak2) {
            return v1;
        }
        float peak = lesser(now->top, sqrtf(peak2));
        if (peak > v && split(ticks, (peak - v) / acceleration)) {
            return peak;
        }
    } else if (v == now->top && v > 0.0f) {
        float cruise = now->left - (v * v - exit_speed2) / (2.0f * acceleration);
        if (cruise >= v * dt) {
            return v;
        }
        if (split(ticks, cruise / v)) {
            return v;
        }
    }
    v1 = lesser(lesser(v1, now->top), profile_braking_speed(now, exit_speed2, *ticks * TICK_S));
    v1 = greater(v1, greater(v - acceleration * dt * BRAKING_SLACK, 0.0f));
    if (v1 <= 0.0f && exit_speed2 <= 0.0f && 0.5f * v * dt > now->left) {
        // Stops within the slice, braking as before.
        *ticks = 2.00001f * now->left / v * (float)HAL_TICK_HZ;
    }
    return v1;
}
