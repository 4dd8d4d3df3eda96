// Arcs, followed step by step at the pins: shape, ends, time, limits of the way, refusals.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"

#define TURN (2 * M_PI)

static const double scale[AXIS_COUNT] = {80, 80, 400, 10};

void setUp(void) {}
void tearDown(void) {}

static double uniform(double low, double high) {
    return low + (high - low) * rand() / RAND_MAX;
}

// ---- The arc as it should be ---------------------------------------------------------------------

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

// Goes on from `part` to the place nearest to the motors; returns how far off they are there, in steps.
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

// Follows it to its end. Fails if the motors ever leave it by more than `steps`; returns the time in s.
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

// ---- Shape ---------------------------------------------------------------------------------------

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

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_full_circle_takes_its_time);
    RUN_TEST(test_random_arcs_end_exactly_and_stay_on_their_way);
    RUN_TEST(test_end_off_the_circle);
    RUN_TEST(test_several_turns);
    return UNITY_END();
}
