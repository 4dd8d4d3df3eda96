// Arcs, followed step by step at the pins: shape, ends, time, limits of the way, refusals.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "stepper/geometry.h"

#define TURN (2 * M_PI)

static const double scale[AXIS_COUNT] = {80, 80, 400, 10};

void setUp(void) {}
void tearDown(void) {}

static double uniform(double low, double high) {
    return low + (high - low) * rand() / RAND_MAX;
}

// ---- The arc as it should be --------------------------------------------------------------------

// Start, centre in machine coordinates, angles and radii of an arc; `from` is where it begins.
typedef struct {
    stepper_arc_t wanted;
    double from[AXIS_COUNT];
    double centre[2];
    double angle, sweep, radius, end_radius;
} ideal_t;

// An arc of `sweep` radians around `centre` (from the start) in the plane of two axes.
static ideal_t ideal(axis_id_t first, axis_id_t second, const double centre[2], double sweep) {
    ideal_t arc = {.sweep = sweep};
    stepper_target(arc.from);
    arc.angle = atan2(-centre[1], -centre[0]);
    arc.radius = arc.end_radius = hypot(centre[0], centre[1]);
    arc.wanted = (stepper_arc_t){
        .move = {.feed = 3000},
        .plane = {first, second},
        .centre = {centre[0], centre[1]},
        .clockwise = sweep < 0,
        .turns = (uint32_t)ceil(fabs(sweep) / TURN - 1e-9),
    };
    stepper_target(arc.wanted.move.target);
    for (unsigned n = 0; n < 2; n++) {
        arc.centre[n] = arc.from[arc.wanted.plane[n]] + centre[n];
    }
    if (fabs(remainder(sweep, TURN)) > 1e-9) {
        arc.wanted.move.target[first] = arc.centre[0] + arc.radius * cos(arc.angle + sweep);
        arc.wanted.move.target[second] = arc.centre[1] + arc.radius * sin(arc.angle + sweep);
    }
    return arc;
}

// Where rounding to steps puts a place, seen from it.
static double rounding(axis_id_t axis, double place) {
    return round(place * scale[axis]) / scale[axis] - place;
}

static void place_at(const ideal_t *arc, double part, double place[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        place[axis] = arc->from[axis] + (arc->wanted.move.target[axis] - arc->from[axis]) * part;
    }
    double radius = arc->radius + (arc->end_radius - arc->radius) * part;
    double angle = arc->angle + arc->sweep * part;
    place[arc->wanted.plane[0]] = arc->centre[0] + radius * cos(angle);
    place[arc->wanted.plane[1]] = arc->centre[1] + radius * sin(angle);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        place[axis] += (1 - part) * rounding(axis, arc->from[axis]) +
                       part * rounding(axis, arc->wanted.move.target[axis]);
    }
}

// How far the motors are from a place on the arc, each axis in its steps.
static double distance(const ideal_t *arc, double part) {
    double place[AXIS_COUNT];
    place_at(arc, part, place);
    double square = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double off = (double)bench.motors[axis].position_steps - place[axis] * scale[axis];
        square += off * off;
    }
    return sqrt(square);
}

// Goes on from `part` to the place nearest to the motors; returns how far off they are there, in
// steps.
static double track(const ideal_t *arc, double *part) {
    double stride = 0.02 / fmax(1, fabs(arc->sweep) / TURN);
    double nearest = distance(arc, *part);
    for (; stride > 1e-8; stride *= 0.5) {
        for (int side = -1; side <= 1; side += 2) {
            double there = fmin(*part + side * stride, 1);
            while (distance(arc, there) < nearest) {
                nearest = distance(arc, there);
                *part = there;
                there = fmin(*part + side * stride, 1);
            }
        }
    }
    return nearest;
}

// Follows it to its end. Fails if the motors ever leave it by more than `steps`; returns the time
// in s.
static double follow(const ideal_t *arc, double steps) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_arc(&arc->wanted), err_message());
    uint64_t begin_us = hal_time_us();
    double part = 0;
    double most = 0;
    while (stepper_active() > 0) {
        bench_wait_us(500);
        most = fmax(most, track(arc, &part));
    }
    TEST_ASSERT_TRUE_MESSAGE(part > 0.98, "not all of the arc");
    if (most > steps) {
        printf("%.3f steps off the arc with radius %.3f, sweep %.3f\n", most, arc->radius,
               arc->sweep);
    }
    TEST_ASSERT_TRUE(most <= steps);
    bench_check_positions();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_EQUAL_INT32(lround(arc->wanted.move.target[axis] * scale[axis]),
                                stepper_position_steps(axis));
    }
    return (double)(hal_time_us() - begin_us) * 1e-6;
}

// ---- Shape --------------------------------------------------------------------------------------

static void test_full_circle_takes_its_time(void) {
    bench_start();
    for (int direction = -1; direction <= 1; direction += 2) {
        ideal_t circle = ideal(AXIS_X, AXIS_Y, (double[]){-20, 0}, direction * TURN);
        TEST_ASSERT_DOUBLE_WITHIN(0.02 * 2.61, 2.61, follow(&circle, 1.0));
    }
    bench_end();
}

static void test_random_arcs_end_exactly_and_stay_on_their_way(void) {
    static const axis_id_t planes[3][2] = {{AXIS_X, AXIS_Y}, {AXIS_Z, AXIS_X}, {AXIS_Y, AXIS_Z}};
    bench_start();
    srand(1);
    for (int i = 0; i < 120; i++) {
        double radius = exp(uniform(log(0.02), log(8)));
        double angle = uniform(0, TURN);
        double sweep = uniform(0.02, 1.3 * TURN) * (rand() % 2 ? 1 : -1);
        const axis_id_t *plane = planes[i % 3];
        ideal_t arc =
            ideal(plane[0], plane[1], (double[]){radius * cos(angle), radius * sin(angle)}, sweep);
        arc.wanted.move.feed = uniform(100, 6000);
        axis_id_t third = (axis_id_t)(3 - plane[0] - plane[1]);
        if (rand() % 2) {
            arc.wanted.move.target[third] += uniform(-3, 3);
        }
        if (rand() % 3 == 0) {
            arc.wanted.move.target[AXIS_A] += uniform(-90, 90);
        }
        follow(&arc, 1.0);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_step_gap_ns);
    bench_end();
}

// A tenth of a millimetre of mismatch on a large radius is spread over the arc.
static void test_end_off_the_circle(void) {
    bench_start();
    ideal_t arc = ideal(AXIS_X, AXIS_Y, (double[]){0, 25}, 3.0);
    arc.end_radius = 25.028;
    place_at(&arc, 1, arc.wanted.move.target);
    follow(&arc, 1.0);
    arc = ideal(AXIS_X, AXIS_Y, (double[]){0, 200}, 0.5);
    arc.end_radius = 199.81;
    place_at(&arc, 1, arc.wanted.move.target);
    follow(&arc, 1.0);
    bench_end();
}

static void test_several_turns(void) {
    bench_start();
    ideal_t arc = ideal(AXIS_X, AXIS_Y, (double[]){0, 2}, -7.25 * TURN);
    arc.wanted.move.target[AXIS_Z] = -4;
    follow(&arc, 1.0);
    arc = ideal(AXIS_X, AXIS_Y, (double[]){1, 0}, 5 * TURN);
    follow(&arc, 1.0);
    bench_end();
}

// F is the speed of X, Y and Z; A takes part in the length but not in the feed.
static void test_feed_is_that_of_the_linear_axes(void) {
    bench_start();
    ideal_t arc = ideal(AXIS_X, AXIS_Y, (double[]){20, 0}, M_PI);
    arc.wanted.move.feed = 1200;
    arc.wanted.move.target[AXIS_A] = 180;
    TEST_ASSERT_DOUBLE_WITHIN(0.02, M_PI * 20 / 20 + 0.04, follow(&arc, 1.0));
    arc = ideal(AXIS_X, AXIS_Y, (double[]){20, 0}, M_PI);
    arc.wanted.move.feed = 1200;
    arc.wanted.move.target[AXIS_Z] = 30;
    TEST_ASSERT_DOUBLE_WITHIN(0.1, hypot(M_PI * 20, 30) / 20 + 0.1, follow(&arc, 1.0));
    bench_end();
}

// The governor's chords of 1 ms: 0.001 mm high at 200 mm/s on a radius of 5 mm.
static void test_arc_tolerance_limits_the_speed(void) {
    const stepper_axis_t quick = {
        .steps_per_unit = 80, .max_velocity = 37000, .max_acceleration = 100000};
    bench_start_with(&quick, 32, false);
    const double speeds[] = {200, 616};
    const float tolerances[] = {0.001f, 0.1f};
    for (size_t i = 0; i < 2; i++) {
        geometry_settings.arc_tolerance = tolerances[i];
        stepper_arc_t circle = {
            .move = {.feed = 37000},
            .plane = {AXIS_X, AXIS_Y},
            .centre = {5, 0},
            .turns = 20,
        };
        TEST_ASSERT_EQUAL(ERR_OK, stepper_arc(&circle));
        double time_s = 20 * TURN * 5 / speeds[i];
        TEST_ASSERT_DOUBLE_WITHIN(0.05 * time_s, time_s, bench_finish(10));
    }
    bench_end();
}

static void check_refused(const stepper_arc_t *arc, const char *message) {
    TEST_ASSERT_NOT_EQUAL(ERR_OK, stepper_arc(arc));
    TEST_ASSERT_EQUAL_STRING(message, err_message());
}

static void test_refusals(void) {
    bench_start();
    stepper_arc_t arc = {.move = {.feed = 600}, .plane = {AXIS_X, AXIS_Y}, .turns = 1};
    check_refused(&arc, "The arc has no radius");
    arc.centre[0] = 1e9;
    check_refused(&arc, "The radius of the arc is too large");
    arc.centre[0] = NAN;
    check_refused(&arc, "The arc has no radius");
    arc.centre[0] = INFINITY;
    TEST_ASSERT_NOT_EQUAL(ERR_OK, stepper_arc(&arc));
    arc.centre[0] = 3.2e6;
    check_refused(&arc, "The radius of the arc is too large");
    arc.centre[0] = 1;
    arc.move.target[AXIS_X] = NAN;
    TEST_ASSERT_NOT_EQUAL(ERR_OK, stepper_arc(&arc));
    TEST_ASSERT_EQUAL_UINT32(32, stepper_blocks_free());
    bench_end();
}

static void test_arcs_below_a_step_are_over_at_once(void) {
    const stepper_axis_t coarse = {
        .steps_per_unit = 0.1, .max_velocity = 6000, .max_acceleration = 500};
    bench_start_with(&coarse, 32, false);
    for (int i = 0; i < 100; i++) {
        stepper_arc_t arc = {
            .move = {.feed = 600},
            .plane = {AXIS_X, AXIS_Y},
            .centre = {0.01, 0},
            .turns = 100,
        };
        TEST_ASSERT_EQUAL(ERR_OK, stepper_arc(&arc));
        arc.centre[0] = 0.002;
        arc.turns = 1;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_arc(&arc));
        bench_finish(100);
    }
    TEST_ASSERT_EQUAL_INT64(0, bench.motors[AXIS_X].position_steps);
    bench_end();
}

// Far outside any machine, and tiny; the end is exact and nothing hangs.
static void test_extreme_scales_and_accelerations(void) {
    const double scales[] = {0.01, 1, 10000};
    const double accelerations[] = {1, 100000};
    for (size_t s = 0; s < 3; s++) {
        for (size_t a = 0; a < 2; a++) {
            stepper_axis_t config = {
                .steps_per_unit = scales[s],
                .max_velocity = 60 * 5000 / scales[s],
                .max_acceleration = accelerations[a],
            };
            bench_start_with(&config, 32, false);
            double radius = 50 / scales[s];
            stepper_arc_t arc = {
                .move = {.target = {2 * radius, 0, 0, 0}, .feed = 1e9},
                .plane = {AXIS_X, AXIS_Y},
                .centre = {radius, 0},
                .turns = 2,
            };
            TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_arc(&arc), err_message());
            bench_finish(100000);
            TEST_ASSERT_EQUAL_INT64(100, bench.motors[AXIS_X].position_steps);
            TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_step_gap_ns);
            bench_end();
        }
    }
}

static void test_stops_and_holds_inside_arcs(void) {
    bench_start();
    for (int i = 0; i < 60; i++) {
        stepper_arc_t arc = {
            .move = {.feed = 6000},
            .plane = {AXIS_X, AXIS_Y},
            .centre = {5, 0},
            .clockwise = i % 2,
            .turns = 2,
        };
        double from[AXIS_COUNT];
        stepper_target(from);
        memcpy(arc.move.target, from, sizeof from);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_arc(&arc));
        bench_wait_us(1000 + (uint64_t)i * 9973);
        stepper_hold(true);
        bench_wait_us(300000);
        double radius = hypot((double)bench.motors[0].position_steps / 80.0 - from[0] - 5,
                              (double)bench.motors[1].position_steps / 80.0 - from[1]);
        TEST_ASSERT_DOUBLE_WITHIN(1.5 / 80, 5, radius);
        bench_check_positions();
        stepper_hold(false);
        if (i % 3 == 0) {
            bench_wait_us(50000);
            stepper_stop();
        }
        bench_finish(10);
        bench_check_positions();
        if (i % 3 != 0) {
            TEST_ASSERT_EQUAL_INT32(lround(from[0] * 80), stepper_position_steps(AXIS_X));
            TEST_ASSERT_EQUAL_INT32(lround(from[1] * 80), stepper_position_steps(AXIS_Y));
        }
    }
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_full_circle_takes_its_time);
    RUN_TEST(test_random_arcs_end_exactly_and_stay_on_their_way);
    RUN_TEST(test_end_off_the_circle);
    RUN_TEST(test_several_turns);
    RUN_TEST(test_feed_is_that_of_the_linear_axes);
    RUN_TEST(test_arc_tolerance_limits_the_speed);
    RUN_TEST(test_refusals);
    RUN_TEST(test_arcs_below_a_step_are_over_at_once);
    RUN_TEST(test_extreme_scales_and_accelerations);
    RUN_TEST(test_stops_and_holds_inside_arcs);
    return UNITY_END();
}
