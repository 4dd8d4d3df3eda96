// Arcs: what stepper_arc() asks for, in numbers that can be planned and followed. Context: main
// loop.
//
// Speed and acceleration along an arc share what the axes allow with the acceleration towards its
// centre: both together form a vector that turns round, so its length stays below the lesser of the
// plane's axes.
#include "stepper/arc.h"

#include <float.h>
#include <math.h>

#include "stepper/axis.h"
#include "stepper/extremes.h"
#include "stepper/trig.h"

#define RADIANS_PER_TURN 6.283185307179586
#define SAME_PLACE_MM 1e-6
#define RADIUS_MIN_MM 0.00127
#define RADIUS_RELATIVE 0.001
#define RADIUS_GROSSLY_OFF 100.0
// The fixed point of the path holds radii up to these.
#define RADIUS_MAX_STEPS 2.5e8
#define RADIUS_MAX_MM 1073741824.0
// Part of the acceleration that may be used to turn; half of it is left along the arc then.
#define TURNING_MAX 0.866f
// The governor follows an arc in chords of this time.
#define CHORD_S 0.001f

// ---- Measures -----------------------------------------------------------------------------------

static double length_of(const double v[2]) {
    return sqrt(v[0] * v[0] + v[1] * v[1]);
}

static err_t check_radii(const arc_t *arc, double at_start, double at_end) {
    if (!(at_start >= RADIUS_MIN_MM && at_end >= RADIUS_MIN_MM)) {
        return err_raise(ERR_ARC_NO_RADIUS, NULL);
    }
    double off = fabs(at_end - at_start);
    if (off > STEPPER_ARC_ROUNDING_MM && (off > RADIUS_RELATIVE * fmax(at_start, at_end) ||
                                          off > RADIUS_GROSSLY_OFF * STEPPER_ARC_ROUNDING_MM)) {
        return err_raise(ERR_ARC_END_OFF, "%.3f mm", off);
    }
    for (unsigned n = 0; n < 2; n++) {
        double steps = arc->radius * axes[arc->plane[n]].config.steps_per_unit;
        if (!(steps < RADIUS_MAX_STEPS && arc->radius < RADIUS_MAX_MM)) {
            return err_raise(ERR_ARC_TOO_LARGE, NULL);
        }
    }
    return ERR_OK;
}

// Turns from start to end, in the direction of the arc; an arc that ends where it started is a full
// one.
static double find_turns(const arc_t *arc, const stepper_arc_t *wanted) {
    const double chord[2] = {arc->end[0] - arc->start[0], arc->end[1] - arc->start[1]};
    double turns = 0.0;
    if (length_of(chord) > SAME_PLACE_MM) {
        double along = arc->start[0] * arc->end[0] + arc->start[1] * arc->end[1];
        double across = arc->start[0] * arc->end[1] - arc->start[1] * arc->end[0];
        turns = trig_angle(along, across);
    }
    turns = wanted->clockwise ? -turns : turns;
    turns = (turns > 0.0 ? turns : turns + 1.0) + (wanted->turns - 1u);
    return wanted->clockwise ? -turns : turns;
}

err_t arc_measure(arc_t *arc, const stepper_arc_t *wanted, const double from[AXIS_COUNT]) {
    for (unsigned n = 0; n < 2; n++) {
        axis_id_t axis = wanted->plane[n];
        arc->plane[n] = axis;
        arc->centre[n] = from[axis] + wanted->centre[n];
        arc->start[n] = -wanted->centre[n];
        arc->end[n] = wanted->move.target[axis] - arc->centre[n];
    }
    double at_start = length_of(arc->start);
    double at_end = length_of(arc->end);
    arc->radius = 0.5 * (at_start + at_end);
    err_t err = check_radii(arc, at_start, at_end);
    if (err == ERR_OK) {
        arc->turns = find_turns(arc, wanted);
    }
    return err;
}

// A measure of the direction of a vector that grows with its angle, by one for each quarter turn:
// 0..4.
static double direction_of(const double v[2]) {
    double part = v[1] / (fabs(v[0]) + fabs(v[1]));
    if (v[0] < 0.0) {
        return 2.0 - part;
    }
    return part < 0.0 ? 4.0 + part : part;
}

// The arc passes the direction that lies `quarter` quarter turns from the first axis.
static bool passes(const arc_t *arc, double quarter) {
    if (fabs(arc->turns) >= 1.0) {
        return true;
    }
    double from = direction_of(arc->turns > 0.0 ? arc->start : arc->end);
    double to = direction_of(arc->turns > 0.0 ? arc->end : arc->start);
    double way = to < from ? to - from + 4.0 : to - from;
    double there = quarter < from ? quarter - from + 4.0 : quarter - from;
    return there < way;
}

void arc_extent(const arc_t *arc, unsigned n, double *low, double *high) {
    double end = arc->end[n];
    *low = arc->centre[n] + (passes(arc, n == 0 ? 2 : 3) ? fmin(-arc->radius, end) : end);
    *high = arc->centre[n] + (passes(arc, n == 0 ? 0 : 1) ? fmax(arc->radius, end) : end);
}

double arc_way(const arc_t *arc) {
    return arc->radius * fabs(arc->turns) * RADIANS_PER_TURN;
}

bool arc_is_below_a_step(const arc_t *arc) {
    double way = arc_way(arc);
    return way * axes[arc->plane[0]].config.steps_per_unit < 0.5 &&
           way * axes[arc->plane[1]].config.steps_per_unit < 0.5;
}

// ---- Limits -------------------------------------------------------------------------------------

// Greatest share that each axis ever has in the direction of the path.
static void find_shares(float share[AXIS_COUNT], const arc_t *arc, float in_plane,
                        const double delta[AXIS_COUNT], float per_length) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        share[axis] = fabsf((float)delta[axis]) * per_length;
    }
    share[arc->plane[0]] = in_plane;
    share[arc->plane[1]] = in_plane;
}

static void find_directions(geometry_t *g, const arc_t *arc, float in_plane,
                            const double delta[AXIS_COUNT], float per_length) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        g->start[axis] = (float)delta[axis] * per_length;
        g->end[axis] = g->start[axis];
    }
    float turning = arc->turns > 0.0 ? in_plane : -in_plane;
    float at_start = turning / (float)length_of(arc->start);
    float at_end = turning / (float)length_of(arc->end);
    g->start[arc->plane[0]] = -(float)arc->start[1] * at_start;
    g->start[arc->plane[1]] = (float)arc->start[0] * at_start;
    g->end[arc->plane[0]] = -(float)arc->end[1] * at_end;
    g->end[arc->plane[1]] = (float)arc->end[0] * at_end;
}

// `curve` times the square of the path speed is the acceleration towards the centre.
static void limit_turning(geometry_t *g, const arc_t *arc, float in_plane, float curve,
                          float arc_tolerance) {
    float acceleration = lesser(axes[arc->plane[0]].acceleration, axes[arc->plane[1]].acceleration);
    // The height of a chord's arc above it: (v dt)^2 / (8 r).
    float chords2 = 8.0f * arc_tolerance / (curve * CHORD_S * CHORD_S);
    g->axes_speed = lesser(g->axes_speed, sqrtf(chords2));
    float top = geometry_top_speed(g);
    float turning = geometry_turning_share(top * top * curve / acceleration, TURNING_MAX);
    g->axes_speed = lesser(g->axes_speed, sqrtf(turning * acceleration / curve));
    float left = sqrtf(1.0f - turning * turning);
    g->acceleration = lesser(g->acceleration, left * acceleration / in_plane);
}

void arc_geometry(geometry_t *g, const arc_t *arc, const double delta[AXIS_COUNT],
                  const stepper_move_t *move) {
    double way = arc_way(arc);
    axis_id_t third = (axis_id_t)(AXIS_X + AXIS_Y + AXIS_Z - arc->plane[0] - arc->plane[1]);
    double linear2 = way * way + delta[third] * delta[third];
    g->length = (float)sqrt(linear2 + delta[AXIS_A] * delta[AXIS_A]);
    g->feed = move->rapid ? 0.0f : (float)move->feed / 60.0f * (g->length / sqrtf((float)linear2));
    float per_length = 1.0f / g->length;
    float in_plane = (float)way * per_length;
    float share[AXIS_COUNT];
    find_shares(share, arc, in_plane, delta, per_length);
    geometry_project_limits(g, share);
    find_directions(g, arc, in_plane, delta, per_length);
    limit_turning(g, arc, in_plane, in_plane * in_plane / (float)arc->radius,
                  (float)geometry_settings.arc_tolerance);
}

// ---- For the path -------------------------------------------------------------------------------

void arc_fill(block_t *block, const arc_t *arc) {
    int exponent;
    frexp(fmax(fabs(arc->start[0]), fabs(arc->start[1])),
          &exponent); // below 2^exponent, at most 2^30
    int scale = exponent < -1 ? 31 : 30 - exponent;
    block->plane = arc_plane_of(arc->plane) & 7u;
    block->move.arc.scale = (uint32_t)scale & 31u;
    for (unsigned n = 0; n < 2; n++) {
        block->move.arc.centre[n] = (int32_t)floor(0.5 - ldexp(arc->start[n], scale));
    }
    block->move.arc.clockwise = arc->turns < 0.0;
    double turns = fabs(arc->turns);
    bool several = turns > 0.9999999;
    block->move.arc.several = several;
    block->move.arc.turns = (uint32_t)(ldexp(turns, several ? 18 : 25) + 0.5) & 0x1ffffffu;
}
