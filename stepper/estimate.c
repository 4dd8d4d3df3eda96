// How long motion will take. Context: main loop.
//
// The moves go through a window. When it is full the first half of it is timed: a pass from its end
// (at rest there) to its beginning says how fast each corner may be passed, a pass forwards how
// fast it will be. What is timed leaves the window.
#include <float.h>
#include <math.h>
#include <string.h>

#include "stepper/arc.h"
#include "stepper/axis.h"
#include "stepper/extremes.h"
#include "stepper/geometry.h"
#include "stepper/planner.h"
#include "stepper/span.h"
#include "stepper/stepper_estimate.h"

#define WINDOW STEPPER_ESTIMATE_MOVES

typedef struct {
    float length;       // units
    float top;          // the most that is allowed anywhere on it, units/s
    float acceleration; // units/s^2
    float jerk;         // units/s^3; 0: no limit
    float entry2;       // square of the speed that the corner before it allows
} move_t;

typedef struct {
    double seconds;            // of what has left the window
    double target[AXIS_COUNT]; // where the last move ends
    geometry_t last;           // of it
    bool corner;               // there is one
    bool blends;               // it is a line whose end may be rounded off
    uint32_t count;            // moves in the window
    float entry;               // speed at which the first of them begins
    float run_length;          // of the moves before it without a slow corner between
    move_t moves[WINDOW];
} window_t;

_Static_assert(sizeof(window_t) <= sizeof(stepper_estimate_t), "stepper_estimate_t is too small");

static window_t *window_of(stepper_estimate_t *estimate) {
    return (window_t *)(void *)estimate->store;
}

// ---- Jerk ---------------------------------------------------------------------------------------
//
// A change of speed by D takes D / A + A / J instead of D / A, or 2 sqrt(D / J) if A is not
// reached. It is timed as one with the even acceleration that takes as long. D is the change
// between the slow corners at both ends of a run of moves and what can be reached between them.

// Corners passed with less than this part of the speed end a run.
#define SLOW_CORNER 0.7f

static float ramp_time(float change, float acceleration, float jerk) {
    return change * jerk < acceleration * acceleration
               ? 2.0f * sqrtf(change / jerk)
               : change / acceleration + acceleration / jerk;
}

// The C library's differs from board to board. A third of the bits of a float is its cube root to
// within 4 %; each of Newton's steps squares what is wrong with that.
static float cube_root(float x) {
    float root = span_float_from_bits(span_float_bits(x) / 3 + 0x2A5119F2u);
    for (unsigned n = 0; n < 3; n++) {
        root -= (root - x / (root * root)) / 3.0f;
    }
    return root;
}

// The speed that is reached from rest on half of `length`.
static float speed_within(float length, float acceleration, float jerk) {
    float half = 0.5f * length;
    float by_jerk = cube_root(half * half * jerk); // half = v sqrt(v / J)
    if (by_jerk * jerk < acceleration * acceleration) {
        return by_jerk;
    }
    // half = v / 2 (v / A + A / J)
    float lag = acceleration / jerk;
    return 0.5f * acceleration * (sqrtf(lag * lag + 8.0f * half / acceleration) - lag);
}

static float even_acceleration(const move_t *move, float run_length, float slowest) {
    float reach = speed_within(run_length, move->acceleration, move->jerk);
    float change = greater(lesser(move->top, reach + slowest) - slowest, 0.01f * move->top);
    return change / ramp_time(change, move->acceleration, move->jerk);
}

static bool ends_run(const move_t *moves, uint32_t next) {
    float top = lesser(moves[next - 1].top, moves[next].top) * SLOW_CORNER;
    return moves[next].entry2 < top * top;
}

// Fills in the accelerations that the moves are timed with.
static void find_accelerations(const window_t *window, float even[WINDOW]) {
    float before = window->run_length;
    for (uint32_t first = 0, end; first < window->count; first = end) {
        const move_t *moves = window->moves;
        float length = before + moves[first].length;
        for (end = first + 1; end < window->count && !ends_run(moves, end); end++) {
            length += moves[end].length;
        }
        float slowest2 =
            end < window->count ? lesser(moves[first].entry2, moves[end].entry2) : 0.0f;
        for (uint32_t i = first; i < end; i++) {
            even[i] = moves[i].jerk > 0.0f ? even_acceleration(&moves[i], length, sqrtf(slowest2))
                                           : moves[i].acceleration;
        }
        before = 0.0f;
    }
}

// ---- The window ---------------------------------------------------------------------------------

// Speeds up from `entry` as long as possible, and is at `exit` in the end.
static float time_of(const move_t *move, float acceleration, float entry, float exit) {
    float peak2 = 0.5f * (entry * entry + exit * exit) + acceleration * move->length;
    float peak = lesser(move->top, sqrtf(peak2));
    float changes = (2.0f * peak - entry - exit) / acceleration;
    float ramps =
        (peak * peak - 0.5f * (entry * entry + exit * exit)) / acceleration; // their length
    return changes + greater(move->length - ramps, 0.0f) / peak;
}

static void drop_first(window_t *window, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        bool goes_on = i + 1 < window->count && !ends_run(window->moves, i + 1);
        window->run_length = goes_on ? window->run_length + window->moves[i].length : 0.0f;
    }
    window->count -= count;
    memmove(window->moves, window->moves + count, window->count * sizeof window->moves[0]);
}

// Times the first `count` moves.
static void settle(window_t *window, uint32_t count) {
    float even[WINDOW];
    float reach2[WINDOW + 1]; // square of the speed from which the end of the window can be met
    find_accelerations(window, even);
    reach2[window->count] = 0.0f;
    for (uint32_t i = window->count; i-- > 0;) {
        const move_t *move = &window->moves[i];
        reach2[i] = lesser(move->entry2, reach2[i + 1] + 2.0f * even[i] * move->length);
    }
    for (uint32_t i = 0; i < count; i++) {
        const move_t *move = &window->moves[i];
        float entry2 = lesser(window->entry * window->entry, reach2[i]);
        float exit2 = lesser(reach2[i + 1], entry2 + 2.0f * even[i] * move->length);
        float exit = sqrtf(exit2);
        window->seconds += (double)time_of(move, even[i], sqrtf(entry2), exit);
        window->entry = exit;
    }
    drop_first(window, count);
}

static float top_of(const geometry_t *g) {
    return g->feed > 0.0f ? lesser(g->feed * blocks.override.feed, g->axes_speed)
                          : g->axes_speed * blocks.override.rapid;
}

static void add(window_t *window, const geometry_t *g, float length, float corner2) {
    if (window->count == WINDOW) {
        settle(window, WINDOW / 2);
    }
    float top = top_of(g);
    float before = window->count > 0 ? window->moves[window->count - 1].top : 0.0f;
    float side = lesser(top, before);
    window->moves[window->count++] = (move_t){
        .length = length,
        .top = top,
        .acceleration = g->acceleration,
        .jerk = g->jerk,
        .entry2 = lesser(corner2, side * side),
    };
}

static void follow(window_t *window, const geometry_t *g, const double target[AXIS_COUNT]) {
    memcpy(window->target, target, sizeof window->target);
    window->last = *g;
    window->corner = true;
}

// Rounds the corner to the line `g` off, if that is what happens there.
static bool add_blended(window_t *window, const geometry_t *g, const stepper_move_t *move) {
    geometry_t curve;
    float reach;
    if (move->corner != STEPPER_CORNER_BLEND || !window->blends || window->count == 0 ||
        !geometry_blend(&curve, &window->last, g, (float)move->blend_mm, &reach)) {
        return false;
    }
    window->moves[window->count - 1].length -= reach;
    add(window, &curve, curve.length, FLT_MAX);
    add(window, g, g->length - reach, FLT_MAX);
    return true;
}

// A move that ends at the step where it begins is none; its way is part of the next one.
static bool is_below_a_step(const window_t *window, const double target[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int32_t from, to;
        if (axes[axis].configured && axis_to_steps(axis, window->target[axis], &from) &&
            axis_to_steps(axis, target[axis], &to) && from != to) {
            return false;
        }
    }
    return true;
}

static void find_delta(double delta[AXIS_COUNT], const window_t *window,
                       const double target[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        delta[axis] = target[axis] - window->target[axis];
    }
}

static float corner_before(const window_t *window, const geometry_t *g, stepper_corner_t corner) {
    return window->corner ? geometry_corner_speed2(&window->last, g, corner) : 0.0f;
}

// ---- The face -----------------------------------------------------------------------------------

void stepper_estimate_start(stepper_estimate_t *estimate, const double position[AXIS_COUNT]) {
    window_t *window = window_of(estimate);
    *window = (window_t){0};
    memcpy(window->target, position, sizeof window->target);
}

void stepper_estimate_line(stepper_estimate_t *estimate, const stepper_move_t *move) {
    window_t *window = window_of(estimate);
    if (is_below_a_step(window, move->target)) {
        return;
    }
    double delta[AXIS_COUNT];
    find_delta(delta, window, move->target);
    geometry_t g;
    geometry_line(&g, delta, move);
    geometry_even_out(&g);
    if (!add_blended(window, &g, move)) {
        add(window, &g, g.length, corner_before(window, &g, move->corner));
    }
    follow(window, &g, move->target);
    window->blends = move->corner == STEPPER_CORNER_BLEND;
}

err_t stepper_estimate_arc(stepper_estimate_t *estimate, const stepper_arc_t *wanted,
                           double low[AXIS_COUNT], double high[AXIS_COUNT]) {
    window_t *window = window_of(estimate);
    const double *target = wanted->move.target;
    arc_t arc;
    err_t err = arc_measure(&arc, wanted, window->target);
    if (err != ERR_OK) {
        return err;
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        low[axis] = fmin(window->target[axis], target[axis]);
        high[axis] = fmax(window->target[axis], target[axis]);
    }
    for (unsigned n = 0; n < 2; n++) {
        double from, to;
        arc_extent(&arc, n, &from, &to);
        low[arc.plane[n]] = fmin(low[arc.plane[n]], from);
        high[arc.plane[n]] = fmax(high[arc.plane[n]], to);
    }
    if (is_below_a_step(window, target) && arc_is_below_a_step(&arc)) {
        return ERR_OK;
    }
    double delta[AXIS_COUNT];
    find_delta(delta, window, target);
    geometry_t g;
    arc_geometry(&g, &arc, delta, &wanted->move);
    add(window, &g, g.length, corner_before(window, &g, wanted->move.corner));
    follow(window, &g, target);
    window->blends = false;
    return ERR_OK;
}

void stepper_estimate_pause(stepper_estimate_t *estimate, double seconds) {
    window_t *window = window_of(estimate);
    settle(window, window->count);
    window->entry = 0.0f;
    window->run_length = 0.0f;
    window->corner = false;
    window->seconds += seconds;
}

void stepper_estimate_place(stepper_estimate_t *estimate, const double position[AXIS_COUNT]) {
    stepper_estimate_pause(estimate, 0.0);
    memcpy(window_of(estimate)->target, position, sizeof window_of(estimate)->target);
}

double stepper_estimate_seconds(stepper_estimate_t *estimate) {
    stepper_estimate_pause(estimate, 0.0);
    return window_of(estimate)->seconds;
}
