// The speed profile with a limit of the jerk. The acceleration of each slice is the highest within
// the jerk for which every binding cap ahead can still be met: the way that braking to it takes,
// with jerk and acceleration limited and none left at the cap, must not be longer than the way
// there.
//
//   speed |         .-------.                  J  build up  : a rises to A
//         |       .'         '.                0  keep      : a = A
//         |     .'             '.             -J  take back : a falls to 0 at the top speed,
//         |__.-'                 '-.___ cap       and the same downwards to the cap
//
// That looks across blocks, so a thousand short ones run like one long one. Braking as hard as the
// limits allow is always among the choices and meets all caps if the choices before did.
//
// Slices of constant acceleration follow a straight line of jerk if they have its value at their
// middle; so it is the middle of a slice from which the acceleration is thought to change further.
// Context: governor.
#include "stepper/scurve.h"

#include <math.h>
#include <string.h>

#include "stepper/bounds.h"
#include "stepper/extremes.h"
#include "stepper/ramp.h"

#define SLICE_S (SCURVE_TICKS / (float)HAL_TICK_HZ)
#define HALF_SLICE_S (0.5f * SLICE_S)
#define QUIET_S ((SCURVE_QUIET_TICKS + 100.0f) / (float)HAL_TICK_HZ) // and a slice

// Bounds whose speeds are alike count as one, at the place of the nearest and with the speed of the
// slowest: the ratio of their squares, coarser the more have been looked at, since the far ones
// matter less.
#define ALIKE_CHANGES 4u
static const float alike[] = {0.94f, 0.8f, 0.5f};
#define TESTS_MAX (ALIKE_CHANGES * 3u)
#define BOUNDS_MAX 640u
// With more than this it is worth the time to look closely how far ahead they can matter.
#define BOUNDS_FEW 8u

// Braking is planned with a little less than the limits, so that what rounding and slices do to it
// can be made up for on the way.
#define PLANNED_ACCELERATION 0.99f
#define PLANNED_JERK 0.97f
#define PLANNED_CAP2 0.98f // of the square of the speed

#define CREEP 0.4f // units/s
#define HAIR 1.01f

// What follows from the limits of a block; the next one often has the same.
static struct {
    float acceleration, jerk, top;
    v2_t top2; // just above the square of `top`
    ramp_t ramp;
    int32_t within; // how far ahead a bound can matter at `top`, as `way`
} limits;

static bool quiet; // see scurve_is_quiet()

// The choice for one slice while it is made.
typedef struct {
    const profile_t *now;
    ramp_t ramp;       // limits from here to the bound being looked at
    span_t span;       // the same
    int32_t within;    // see above
    float least, most; // accelerations that the jerk limit allows
    float chosen;      // acceleration
    float crest;       // the highest speed that follows if it is taken back then
    bool bound;        // it was lowered for a bound
    bool out_of_reach; // a bound cannot be met within the jerk limit
    unsigned tests;
} choice_t;

static int32_t whole_way(float distance) {
    float way = distance * WAY_ONE;
    return way < 1e9f ? (int32_t)way : 1000000000;
}

// How far ahead a bound can matter while the speed stays below `top`, whatever the acceleration is.
static int32_t reach(const ramp_t *ramp, float top) {
    float taken_back_s = lesser(ramp->build_up_s, sqrtf(2.0f * top * ramp->per_jerk));
    return whole_way(ramp_distance(ramp, top, 0.0f) + top * (HALF_SLICE_S + taken_back_s));
}

// Caps above this are no bound for the speed.
static v2_t v2_above(float speed) {
    float units = speed * speed * (blocks.v2_per_unit * (1.0f / PLANNED_CAP2)) + 1.0f;
    return units < (float)V2_MAX ? (v2_t)units : V2_MAX;
}

// Quicker than a comparison of floats without a floating-point unit.
static bool same(float a, float b) {
    uint32_t bits_a;
    uint32_t bits_b;
    memcpy(&bits_a, &a, sizeof bits_a);
    memcpy(&bits_b, &b, sizeof bits_b);
    return bits_a == bits_b;
}

static void take_limits(choice_t *choice) {
    const profile_t *now = choice->now;
    const block_t *block = now->block;
    choice->span = planner_span_of(block);
    if (!same(block->move.acceleration, limits.acceleration) ||
        !same(block->move.jerk, limits.jerk)) {
        limits.acceleration = block->move.acceleration;
        limits.jerk = block->move.jerk;
        ramp_set(&limits.ramp, PLANNED_ACCELERATION * limits.acceleration,
                 PLANNED_JERK * limits.jerk);
        limits.top = -1.0f;
    }
    choice->ramp = limits.ramp;
    if (now->speed > now->top) {
        choice->within = reach(&limits.ramp, now->speed);
        return;
    }
    if (!same(now->top, limits.top)) {
        limits.top = now->top;
        limits.top2 = v2_above(now->top);
        limits.within = reach(&limits.ramp, now->top);
    }
    choice->within = limits.within;
}

static float crest(const choice_t *choice, float acceleration) {
    float v = choice->now->speed;
    if (acceleration <= 0.0f) {
        return v;
    }
    float half_taken_back_s = 0.5f * acceleration * choice->ramp.per_jerk;
    return v + acceleration * (HALF_SLICE_S + greater(half_taken_back_s, HALF_SLICE_S));
}

// The highest acceleration that jerk, acceleration and top speed allow.
static void choose_freely(choice_t *choice, float elapsed_s) {
    const profile_t *now = choice->now;
    float full = limits.acceleration;
    float step = limits.jerk * elapsed_s;
    float most = now->acceleration + step;
    float least = now->acceleration - step;
    if (most > full) {
        most = greater(full, least);
    }
    if (least < -full) {
        least = lesser(-full, most);
    }
    choice->least = least;
    choice->most = most;
    choice->chosen = most;
    choice->crest = crest(choice, most);
    if (choice->crest > now->top) {
        float rise = now->top - now->speed;
        float towards = 0.0f;
        if (rise != 0.0f) {
            towards = ramp_towards(&choice->ramp, now->speed, now->top, HALF_SLICE_S);
            if (towards * SLICE_S > rise && rise > 0.0f) {
                towards = rise * (1.0f / SLICE_S);
            }
        }
        if (towards >= least) {
            choice->chosen = lesser(most, towards);
            choice->crest = greater(now->top, now->speed);
        } else {
            choice->chosen = least;
            choice->crest = crest(choice, least);
        }
    }
}

// ---- Bounds -------------------------------------------------------------------------------------

// By how much braking ends before `distance` if this slice has `acceleration`.
static float margin(const choice_t *choice, float acceleration, float distance, float cap) {
    float v = choice->now->speed;
    float middle = greater(v + acceleration * HALF_SLICE_S, 0.0f);
    float braking = ramp_braking_distance(&choice->ramp, middle, acceleration, cap);
    if (braking <= 0.0f) {
        return distance; // the bound may well be passed in this slice
    }
    return distance - 0.5f * (v + middle) * HALF_SLICE_S - braking;
}

// Lowers the acceleration as far as the bound needs it. The margin is a concave function of the
// acceleration, so the chord is on the safe side.
static void meet(choice_t *choice, float distance, float cap) {
    float build_up_s = choice->chosen > 0.0f ? choice->chosen * choice->ramp.per_jerk : 0.0f;
    choice->tests++;
    if (choice->crest <= cap || ramp_distance(&choice->ramp, choice->crest, cap) +
                                        choice->crest * (HALF_SLICE_S + build_up_s) <=
                                    distance) {
        return;
    }
    float high = margin(choice, choice->chosen, distance, cap);
    if (high >= 0.0f) {
        return;
    }
    choice->bound = true;
    if (choice->chosen <= choice->least) {
        choice->out_of_reach = true;
        return;
    }
    float low = margin(choice, choice->least, distance, cap);
    if (low <= 0.0f) {
        choice->out_of_reach |= low < 0.0f;
        choice->chosen = choice->least;
    } else {
        choice->chosen = choice->least + (choice->chosen - choice->least) * (low / (low - high));
    }
    choice->crest = crest(choice, choice->chosen);
}

static void take_span(choice_t *choice, span_t span) {
    if (span.acceleration >= choice->span.acceleration && span.jerk >= choice->span.jerk) {
        return;
    }
    choice->span = span_least(choice->span, span);
    ramp_set(
        &choice->ramp,
        lesser(choice->ramp.acceleration, PLANNED_ACCELERATION * span_acceleration(choice->span)),
        lesser(choice->ramp.jerk, PLANNED_JERK * span_jerk(choice->span)));
    choice->within = reach(&choice->ramp, choice->crest);
}

// Limits that are lower behind the first bound must be kept when it is passed, `way` from the end
// of the front block.
static void keep_next_span(choice_t *choice, span_t span, int32_t way) {
    if (span.acceleration >= choice->span.acceleration) {
        return;
    }
    float distance = (float)way * (1.0f / WAY_ONE) + choice->now->left;
    float excess = choice->chosen - span_acceleration(span);
    if (excess > 0.0f && excess * choice->ramp.per_jerk * choice->now->speed >= distance) {
        choice->chosen = greater(choice->least, span_acceleration(span));
        choice->crest = crest(choice, choice->chosen);
    }
}

// Bounds that do not matter are passed over with integers alone; there may be hundreds.
static void meet_bounds(choice_t *choice) {
    const block_t *second = planner_second();
    uint32_t here = second != NULL ? second->way : blocks.end_way;
    v2_t slower = same(choice->crest, limits.top) ? limits.top2 : v2_above(choice->crest);
    int32_t left = whole_way(choice->now->left);
    quiet = false;
    float group_distance = 0.0f;
    float group_speed2 = -1.0f; // none
    float alike_speed2 = 0.0f;
    int32_t way = 0;
    bool looked = false;
    bound_t bound;
    bounds_first(&bound);
    for (uint32_t n = 0; bounds_next(&bound); n++) {
        if (n == 1) {
            keep_next_span(choice, bound.span, way);
        } else if (n >= BOUNDS_FEW && !looked) {
            looked = true;
            int32_t within = reach(&choice->ramp, choice->crest);
            choice->within = within < choice->within ? within : choice->within;
        }
        way = (int32_t)(bound.way - here);
        take_span(choice, bound.span);
        if (way > choice->within - left) {
            quiet = n == 0 && choice->chosen == 0.0f &&
                    way - (choice->within - left) > whole_way(choice->now->speed * QUIET_S);
            break;
        }
        v2_t cap = n < BOUNDS_MAX ? bound.cap : 0;
        if (cap >= slower) {
            n += bounds_skip(&bound, slower, choice->span);
            continue;
        }
        slower = cap;
        float speed2 = (float)cap * (PLANNED_CAP2 * blocks.v2_unit);
        if (group_speed2 < 0.0f || speed2 < alike_speed2) {
            if (group_speed2 >= 0.0f) {
                meet(choice, group_distance, sqrtf(group_speed2));
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

// With less jerk in the next block the acceleration must be one that can be taken back there before
// the top speed is reached.
static void keep_next_jerk(choice_t *choice, const block_t *next) {
    const profile_t *now = choice->now;
    float take_back_s = choice->chosen / next->move.jerk;
    if (choice->chosen <= 0.0f || (take_back_s + SLICE_S) * now->speed < now->left) {
        return;
    }
    float room = planner_top_speed(next) - now->speed - choice->chosen * SLICE_S;
    float most = room > 0.0f ? sqrtf(2.0f * next->move.jerk * room) : 0.0f;
    if (choice->chosen > most) {
        choice->chosen = greater(most, choice->least);
    }
}

// The next block may allow less: what is above that has to be gone when it begins. (Braking for a
// bound is planned with the least limits of all blocks that it goes through.)
static void keep_next_limit(choice_t *choice) {
    const block_t *second = planner_second();
    if (second == NULL || !block_is_move(second)) {
        return;
    }
    const profile_t *now = choice->now;
    if (second->move.jerk > 0.0f && second->move.jerk < limits.jerk) {
        keep_next_jerk(choice, second);
    }
    float next = second->move.acceleration;
    bool free_braking = choice->chosen < 0.0f && !choice->bound;
    float excess = (free_braking ? -choice->chosen : choice->chosen) - next;
    if (excess > 0.0f && (excess * choice->ramp.per_jerk + SLICE_S) * now->speed >= now->left) {
        choice->chosen = free_braking ? lesser(-next, choice->most) : greater(next, choice->least);
    }
}

float scurve_acceleration(const profile_t *now, float elapsed_s) {
    choice_t choice = {.now = now};
    take_limits(&choice);
    choose_freely(&choice, elapsed_s);
    meet_bounds(&choice);
    keep_next_limit(&choice);

    float v1 = now->speed + choice.chosen * SLICE_S;
    if (choice.out_of_reach) {
        // By a hair, or limits fell behind what was promised: speed and acceleration first, jerk
        // last.
        float exit_speed2 = planner_exit_speed2();
        float most =
            HAIR * (now->left > now->speed * SLICE_S
                        ? profile_braking_speed(now, exit_speed2, SLICE_S)
                        : greater(sqrtf(exit_speed2), now->speed - limits.acceleration * SLICE_S));
        if (v1 > most) {
            v1 = most;
            choice.chosen = (most - now->speed) * (1.0f / SLICE_S);
        }
    }
    if (v1 <= 0.0f && now->speed <= 0.0f && now->top > 0.0f) {
        // Not even a slice long: half of the way in this slice.
        return lesser(limits.acceleration, now->left * (1.0f / (SLICE_S * SLICE_S)));
    }
    if (v1 < CREEP && choice.chosen < 0.0f) {
        // What is left in the end may be a hair longer than planned: do not get slower before. A
        // standstill that is asked for is reached at last.
        bool stop = now->top <= 0.0f;
        float creep = stop ? 0.0f : lesser(now->speed, CREEP);
        if (stop ? now->speed <= limits.acceleration * SLICE_S : v1 < creep) {
            return (creep - now->speed) * (1.0f / SLICE_S);
        }
    }
    return choice.chosen;
}

float scurve_speed(float speed, float acceleration, float dt) {
    float change = acceleration * dt;
    float v1 = speed + change;
    // What rounding leaves of a speed that should be 0 would never end.
    return v1 > -0.001f * change ? v1 : 0.0f;
}

bool scurve_is_quiet(void) {
    return quiet;
}
