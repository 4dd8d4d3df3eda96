// The speed profile. Without a limit of the jerk it is made of three pieces, each known exactly:
//
//   speed |       _______________           accelerate until `top` or the braking curve,
//         |     .'               '.         cruise until the braking curve,
//         |___.'                   '.___    brake to what the planner allows at the end of the block
//
// With a limit of the jerk the acceleration of each slice is the highest within the jerk for which every
// binding cap ahead can still be met: the way that braking to it takes, with jerk and acceleration
// limited and none left at the cap, must not be longer than the way there. That looks across blocks,
// so a thousand short ones run like one long one. Braking as hard as the limits allow is always among
// the choices and meets all caps if the choices before did.
// Context: governor.
#include "stepper/profile.h"

#include <math.h>

#include "stepper/ramp.h"

#define TICK_S (1.0f / (float)HAL_TICK_HZ)
// Pieces shorter than this are not worth a segment.
#define PIECE_TICKS_MIN 8.0f

static float lesser(float a, float b) {
    return a < b ? a : b;
}

static float greater(float a, float b) {
    return a > b ? a : b;
}

// ---- Trapezoid -----------------------------------------------------------------------------------

// The braking curve within a slice of dt: solves v1^2 = exit^2 + 2 a (left - (v + v1) / 2 dt), so that
// braking which starts behind this slice still succeeds.
static float braking_speed(const profile_t *now, float exit_speed2, float dt) {
    float acceleration = now->block->move.acceleration;
    float change = acceleration * dt;
    float root2 = change * change +
                  4.0f * (exit_speed2 + 2.0f * acceleration * now->left - change * now->speed);
    float braking = root2 > 0.0f ? 0.5f * (sqrtf(root2) - change) : 0.0f;
    return greater(greater(braking, now->speed - change), 0.0f);
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

static float next_speed_trapezoid(const profile_t *now, float *ticks) {
    float v = now->speed;
    float acceleration = now->block->move.acceleration;
    float dt = *ticks * TICK_S;
    float exit_speed2 = planner_exit_speed2();
    float v1 = v + acceleration * dt;
    if (v < now->top) {
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
    v1 = lesser(lesser(v1, now->top), braking_speed(now, exit_speed2, *ticks * TICK_S));
    return greater(v1, greater(v - acceleration * dt, 0.0f));
}

// ---- S-curve -------------------------------------------------------------------------------------

// Bounds whose speeds are alike count as one, at the place of the nearest and with the speed of the
// slowest: the ratio of their squares, coarser the more have been looked at, since the far ones matter less.
#define ALIKE_CHANGES 4u
static const float alike[] = {0.94f, 0.8f, 0.5f};
#define TESTS_MAX (ALIKE_CHANGES * 3u)
#define BOUNDS_MAX 640u

#define CREEP 0.1f // units/s
#define HAIR 1.01f

// The choice for one slice while it is made.
typedef struct {
    const profile_t *now;
    float half_s;      // half of the slice
    ramp_t ramp;       // limits from here to the bound being looked at
    span_t span;       // the same
    float least;       // acceleration that the jerk limit allows at least
    float chosen;      // acceleration
    bool out_of_reach; // a bound cannot be met within the jerk limit
    unsigned tests;
} choice_t;

// By how much braking ends before `distance` if this slice has `acceleration`. Slices of constant
// acceleration follow a straight line of jerk if they have its value at their middle; so it is the
// middle of this slice from which the acceleration changes further.
static float margin(const choice_t *choice, float acceleration, float distance, float cap) {
    float v = choice->now->speed;
    float middle = greater(v + acceleration * choice->half_s, 0.0f);
    float braking = ramp_braking_distance(&choice->ramp, middle, acceleration, cap);
    if (braking <= 0.0f) {
        return distance; // the bound may well be passed in this slice
    }
    return distance - 0.5f * (v + middle) * choice->half_s - braking;
}

// Lowers the acceleration as far as the bound needs it. The margin is a concave function of the
// acceleration, so the chord is on the safe side.
static void meet(choice_t *choice, float distance, float cap) {
    float high = margin(choice, choice->chosen, distance, cap);
    choice->tests++;
    if (high >= 0.0f || choice->chosen <= choice->least) {
        choice->out_of_reach |= high < 0.0f;
        return;
    }
    float low = margin(choice, choice->least, distance, cap);
    if (low <= 0.0f) {
        choice->out_of_reach |= low < 0.0f;
        choice->chosen = choice->least;
    } else {
        choice->chosen = choice->least + (choice->chosen - choice->least) * (low / (low - high));
    }
}

static bool take_span(choice_t *choice, span_t span) {
    if (span.acceleration >= choice->span.acceleration && span.jerk >= choice->span.jerk) {
        return false;
    }
    choice->span = span_least(choice->span, span);
    ramp_set(&choice->ramp, lesser(choice->ramp.acceleration, span_acceleration(choice->span)),
             lesser(choice->ramp.jerk, span_jerk(choice->span)));
    return true;
}

// The highest speed that follows if `acceleration` is taken back from the middle of this slice on.
static float crest(const choice_t *choice, float acceleration) {
    return acceleration > 0.0f
               ? choice->now->speed +
                     acceleration * (choice->half_s + 0.5f * acceleration * choice->ramp.per_jerk)
               : choice->now->speed;
}

// Limits that are lower behind the first bound must be kept when it is passed, `way` from the end of
// the front block.
static void keep_next_span(choice_t *choice, span_t span, int32_t way) {
    if (span.acceleration >= choice->span.acceleration) {
        return;
    }
    float distance = (float)way * (1.0f / WAY_ONE) + choice->now->left;
    float excess = choice->chosen - span_acceleration(span);
    if (excess > 0.0f && excess * choice->ramp.per_jerk * choice->now->speed >= distance) {
        choice->chosen = greater(choice->least, span_acceleration(span));
    }
}

// How far ahead a bound can matter, in units along the path.
static float reach(const choice_t *choice) {
    float build_up_s = greater(choice->chosen, 0.0f) * choice->ramp.per_jerk;
    float peak = crest(choice, choice->chosen);
    return ramp_distance_bound(&choice->ramp, peak, 0.0f) + peak * (choice->half_s + build_up_s);
}

static v2_t v2_above(float speed) {
    float units = speed * speed / blocks.v2_unit + 1.0f;
    return units < (float)V2_MAX ? (v2_t)units : V2_MAX;
}

// The same in the units of planner_bound_t.way, from the end of the front block.
static int32_t reach_way(const choice_t *choice) {
    float way = (reach(choice) - choice->now->left) * WAY_ONE;
    return way < (float)INT32_MAX ? (int32_t)way : INT32_MAX;
}

// Bounds that do not matter are passed over with integers alone; there may be hundreds.
static void meet_bounds(choice_t *choice) {
    const block_t *second = planner_second();
    uint32_t here = second != NULL ? second->way : blocks.end_way;
    v2_t slower = v2_above(crest(choice, choice->chosen));
    int32_t within = reach_way(choice);
    float group_distance = 0.0f;
    float group_speed2 = -1.0f; // none
    float alike_speed2 = 0.0f;
    int32_t way = 0;
    planner_bound_t bound;
    for (uint32_t n = 0; planner_bound(n, &bound); n++) {
        if (n == 1) {
            keep_next_span(choice, bound.span, way);
        }
        way = (int32_t)(bound.way - here);
        if (take_span(choice, bound.span)) {
            within = reach_way(choice);
        }
        if (way > within) {
            break;
        }
        v2_t cap = n < BOUNDS_MAX ? bound.cap : 0;
        if (cap >= slower) {
            continue;
        }
        slower = cap;
        float speed2 = (float)cap * blocks.v2_unit;
        if (group_speed2 < 0.0f || speed2 < alike_speed2) {
            if (group_speed2 >= 0.0f) {
                meet(choice, group_distance, sqrtf(group_speed2));
                within = reach_way(choice);
            }
            if (choice->tests >= TESTS_MAX) {
                return;
            }
            group_distance = (float)way * (1.0f / WAY_ONE) + choice->now->left;
            alike_speed2 = speed2 * alike[choice->tests / ALIKE_CHANGES];
        }
        group_speed2 = speed2;
        if (cap == 0) {
            break; // whatever comes behind it begins at rest
        }
    }
    if (group_speed2 >= 0.0f) {
        meet(choice, group_distance, sqrtf(group_speed2));
    }
}

static float next_speed_scurve(const profile_t *now, const float *ticks) {
    const block_t *block = now->block;
    float dt = *ticks * TICK_S;
    choice_t choice = {.now = now, .half_s = 0.5f * dt, .span = planner_span_of(block)};
    ramp_set(&choice.ramp, block->move.acceleration, block->move.jerk);
    float step = choice.ramp.jerk * dt;
    float full = choice.ramp.acceleration;
    float most = now->acceleration + step;
    choice.least = now->acceleration - step;
    most = most > full ? greater(full, choice.least) : most;
    choice.least = choice.least < -full ? lesser(-full, most) : choice.least;
    choice.chosen = lesser(most, ramp_towards(&choice.ramp, now->speed, now->top, choice.half_s));
    choice.chosen = greater(choice.chosen, choice.least);
    meet_bounds(&choice);

    float v1 = now->speed + choice.chosen * dt;
    if (choice.out_of_reach) {
        // By a hair, or limits fell behind what was promised: speed and acceleration first, jerk last.
        v1 = lesser(v1, HAIR * braking_speed(now, planner_exit_speed2(), dt));
    }
    // What is left in the end may be a hair longer than planned: never slower than this before.
    float creep = lesser(CREEP, 0.5f * full * dt);
    if (v1 > creep) {
        return v1;
    }
    return now->top > 0.0f ? creep : 0.0f;
}

float profile_next_speed(const profile_t *now, float *ticks) {
    return now->block->move.jerk > 0.0f ? next_speed_scurve(now, ticks)
                                        : next_speed_trapezoid(now, ticks);
}
