// What a new move is like: direction, length, limits, corners. Context: main loop.
//
// Corner speed: junction deviation. The corner is thought replaced by an arc that passes at most
// `deviation` from it; v^2 = a * r on that arc. An arc must also leave each move at its middle at
// the latest, so on a polygon with many corners v^2 / r of the circle stays within the acceleration
// too.
#include "stepper/geometry.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "stepper/axis.h"
#include "stepper/extremes.h"
#include "stepper/planner.h"

// |u - u_prev|^2 / 4 = sin^2(phi/2) for unit vectors with the angle phi between them: straight on
// below the first, back the same way above the last; above the second exact-path mode sees a corner
// (5 degrees).
#define STRAIGHT_ON 2.5e-10f
#define TANGENTIAL 1.9e-3f
#define REVERSAL 0.9999975f
// Joints that count as tangential in exact-path mode are passed with this deviation.
#define TANGENTIAL_DEVIATION_MM 0.0005f

geometry_settings_t geometry_settings;

static float maximum(float a, float b) {
    return a > b ? a : b;
}

// ---- Limits -------------------------------------------------------------------------------------

void geometry_project_limits(geometry_t *g, const float share[AXIS_COUNT]) {
    const geometry_settings_t *settings = &geometry_settings;
    g->axes_speed = FLT_MAX;
    g->acceleration = FLT_MAX;
    g->jerk = settings->scurve ? settings->jerk : 0.0f;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (share[axis] <= 0.0f || !axes[axis].configured) {
            continue;
        }
        g->axes_speed = lesser(g->axes_speed, axes[axis].velocity / share[axis]);
        g->acceleration = lesser(g->acceleration, axes[axis].acceleration / share[axis]);
        if (settings->axis_jerk[axis] > 0.0f) {
            g->jerk = lesser(g->jerk, settings->axis_jerk[axis] / share[axis]);
        }
    }
}

float geometry_top_speed(const geometry_t *g) {
    if (g->feed <= 0.0f) {
        return g->axes_speed;
    }
    float override = blocks.override.feed > 1.0f ? blocks.override.feed : 1.0f;
    return lesser(g->feed * override, g->axes_speed);
}

// Up to twice the speed, since the feed may be overridden later; but as long as the feed itself
// does not need more, nine tenths of the acceleration are left along the path: sqrt(1 - 0.436^2).
#define TURNING_SPARE 0.436f

float geometry_turning_share(float needed, float most) {
    float spare = lesser(4.0f * needed, TURNING_SPARE);
    float at_least = lesser(needed, most);
    return spare > at_least ? spare : at_least;
}

// ---- Lines --------------------------------------------------------------------------------------

void geometry_line(geometry_t *g, const double delta[AXIS_COUNT], const stepper_move_t *move) {
    double linear2 = 0.0;
    for (axis_id_t axis = 0; axis < AXIS_A; axis++) {
        linear2 += delta[axis] * delta[axis];
    }
    double length = sqrt(linear2 + delta[AXIS_A] * delta[AXIS_A]);
    g->length = (float)length;
    float feed_length = linear2 > 0.0 ? sqrtf((float)linear2) : g->length;
    float per_length = 1.0f / g->length;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        g->start[axis] = (float)delta[axis] * per_length;
    }
    float share[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        share[axis] = fabsf(g->start[axis]);
    }
    memcpy(g->end, g->start, sizeof g->end);
    g->feed = move->rapid ? 0.0f : (float)move->feed / 60.0f * (g->length / feed_length);
    geometry_project_limits(g, share);
}

// ---- Corners ------------------------------------------------------------------------------------

// Acceleration that the axes together allow in the direction of `change`, whose length is `size`.
static float acceleration_along(const float change[AXIS_COUNT], float size) {
    float acceleration = FLT_MAX;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        float share = fabsf(change[axis]) / size;
        if (share > 1e-6f && axes[axis].configured) {
            acceleration = lesser(acceleration, axes[axis].acceleration / share);
        }
    }
    return acceleration;
}

float geometry_corner_speed2(const geometry_t *before, const geometry_t *next,
                             stepper_corner_t corner) {
    float change[AXIS_COUNT];
    float change2 = 0.0f;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        change[axis] = next->start[axis] - before->end[axis];
        change2 += change[axis] * change[axis];
    }
    float sin2 = change2 * 0.25f;
    bool exact = corner == STEPPER_CORNER_EXACT;
    if (corner == STEPPER_CORNER_STOP || sin2 > REVERSAL || (exact && sin2 > TANGENTIAL)) {
        return 0.0f;
    }
    if (sin2 < STRAIGHT_ON) {
        return FLT_MAX;
    }
    // Junction deviation in the usual form is r = deviation * s / (1 - s), s = cos(phi/2);
    // 1 - s = sin^2(phi/2) / (1 + s) keeps its precision at small angles.
    float s = sqrtf(1.0f - sin2);
    float acceleration = acceleration_along(change, sqrtf(change2));
    float deviation = exact ? TANGENTIAL_DEVIATION_MM : geometry_settings.deviation;
    float by_deviation = acceleration * deviation * s * (1.0f + s) / sin2;
    float half_length = 0.5f * lesser(before->length, next->length);
    float by_length = acceleration * half_length * s / sqrtf(sin2);
    return lesser(by_deviation, by_length);
}

// ---- Blends -------------------------------------------------------------------------------------
//
// From `reach` before the corner to `reach` behind it the velocity changes evenly from v u to v u',
// in the time 2 reach / v. The acceleration is v^2 (u' - u) / (2 reach), and the middle of the
// curve is reach |u' - u| / 4 from the corner.

// Straight lines keep a little between two blends.
#define BLEND_SHARE 0.4999f
// Part of the acceleration that may be used to turn, and what needs to be at the speed that is
// meant: twice that speed is possible then.
#define BLEND_TURNING_MAX 0.75f
#define BLEND_TURNING 0.109f
// A corner in which the speed changes by less than the acceleration does in this time is passed as
// it is.
#define BLEND_TIME_MIN_S 0.001f

uint32_t geometry_fraction(const geometry_t *line, float length) {
    return (uint32_t)(length / line->length * 4294967296.0f);
}

float geometry_part(const geometry_t *line, uint32_t lead_in, uint32_t lead_out) {
    return (float)(((uint64_t)1 << 32) - lead_in - lead_out) * (line->length / 4294967296.0f);
}

// The slower of both; a rapid move goes at the feed of the other one.
static float blend_feed(const geometry_t *before, const geometry_t *next) {
    if (before->feed <= 0.0f || next->feed <= 0.0f) {
        return before->feed + next->feed;
    }
    return lesser(before->feed, next->feed);
}

bool geometry_blend(geometry_t *g, const geometry_t *before, const geometry_t *next,
                    float tolerance_mm, float *reach) {
    float change[AXIS_COUNT], share[AXIS_COUNT];
    float change2 = 0.0f;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        change[axis] = next->start[axis] - before->end[axis];
        change2 += change[axis] * change[axis];
        share[axis] = maximum(fabsf(next->start[axis]), fabsf(before->end[axis]));
        g->start[axis] = before->end[axis];
        g->end[axis] = next->start[axis];
    }
    if (change2 * 0.25f < STRAIGHT_ON || change2 * 0.25f > REVERSAL) {
        return false;
    }
    g->feed = blend_feed(before, next);
    geometry_project_limits(g, share);
    float top = geometry_top_speed(g);
    float size = sqrtf(change2);
    float turning_limit =
        acceleration_along(change, size) / size; // v^2 / length at the axes' limits
    if (top < turning_limit * BLEND_TIME_MIN_S) {
        return false;
    }
    float room = BLEND_SHARE * lesser(before->length, next->length);
    float needed = 0.5f * top * top / (turning_limit * BLEND_TURNING);
    *reach = lesser(lesser(4.0f * tolerance_mm / size, room), needed);
    g->length = 2.0f * *reach;
    float fastest2 = turning_limit * g->length;
    float turning = geometry_turning_share(top * top / fastest2, BLEND_TURNING_MAX);
    g->axes_speed = lesser(g->axes_speed, sqrtf(turning * fastest2));
    float used = g->axes_speed * g->axes_speed / g->length;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (share[axis] > 0.0f && axes[axis].configured) {
            float left = axes[axis].acceleration - used * fabsf(change[axis]);
            g->acceleration = lesser(g->acceleration, left / share[axis]);
        }
    }
    return true;
}

// ---- S-curves over many short moves -------------------------------------------------------------

// A move that is over before the acceleration could be built up and taken back.
static bool is_short(const geometry_t *g) {
    float top = g->feed > 0.0f ? lesser(g->feed, g->axes_speed) : g->axes_speed;
    return g->length * g->jerk < 2.0f * g->acceleration * top;
}

// The least acceleration in any direction near that of `g`: in a plane with equal axes the same in
// all.
static float even_acceleration(const geometry_t *g) {
    float acceleration = FLT_MAX;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        float share = fabsf(g->start[axis]) * 1.41422f;
        if (share > 0.0f && axes[axis].configured) {
            acceleration = lesser(acceleration, axes[axis].acceleration / lesser(share, 1.0f));
        }
    }
    return lesser(acceleration, g->acceleration);
}

void geometry_even_out(geometry_t *g) {
    if (g->jerk > 0.0f && is_short(g)) {
        g->acceleration = even_acceleration(g);
    }
}
