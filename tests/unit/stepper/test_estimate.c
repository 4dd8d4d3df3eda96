// The estimate of time beside the time that the motors take.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"
#include "stepper/stepper_estimate.h"

#define BLOCKS 64u

static const stepper_axis_t quick = {
    .steps_per_unit = 80, .max_velocity = 12000, .max_acceleration = 3000};

static stepper_estimate_t estimate;
static double place[AXIS_COUNT];
static stepper_corner_t corner;
static double blend_mm;

void setUp(void) {}
void tearDown(void) {}

// ---- Paths --------------------------------------------------------------------------------------

static void await_room(void) {
    while (stepper_blocks_free() < 2) {
        bench_wait_us(200);
    }
}

static stepper_move_t move_to(double x, double y, double feed) {
    place[AXIS_X] = x;
    place[AXIS_Y] = y;
    stepper_move_t move = {.feed = feed, .rapid = feed == 0, .corner = corner};
    move.blend_mm = blend_mm;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        move.target[axis] = place[axis];
    }
    await_room();
    return move;
}

static void line(double x, double y, double feed) {
    stepper_move_t move = move_to(x, y, feed);
    stepper_estimate_line(&estimate, &move);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_move(&move), err_message());
}

static void arc(double x, double y, double i, double j, double feed) {
    double low[AXIS_COUNT], high[AXIS_COUNT];
    stepper_arc_t wanted = {.plane = {AXIS_X, AXIS_Y}, .centre = {i, j}, .turns = 1};
    wanted.move = move_to(x, y, feed);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estimate_arc(&estimate, &wanted, low, high));
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_arc(&wanted), err_message());
}

static void dwell(double seconds) {
    await_room();
    stepper_estimate_pause(&estimate, seconds);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(seconds * 1000));
}

static void long_line(void) {
    line(100, 50, 3000);
}

static void short_line(void) {
    line(0.7, 0, 6000);
}

static void rapids_and_dwells(void) {
    line(50, 0, 0);
    dwell(0.3);
    line(50, 30, 0);
    line(0, 0, 2000);
    dwell(0.05);
}

static void zigzag(void) {
    for (int i = 0; i < 100; i++) {
        line(i * 0.5, i % 2 ? 2 : 0, 5000);
    }
}

static void reversals(void) {
    for (int i = 1; i < 60; i++) {
        line(i % 2 ? i * 0.3 : 0, 0, 5000);
    }
}

static void polygon(void) {
    for (int i = 1; i <= 300; i++) {
        line(20 * sin(i * 0.05), 20 * cos(i * 0.05) - 20, 4000);
    }
}

static void rectangles(void) {
    for (double size = 40; size > 2; size -= 6) {
        line(size, 0, 3000);
        line(size, size, 3000);
        line(0, size, 3000);
        line(0, 0, 3000);
    }
}

static void slots(void) {
    for (int i = 0; i < 12; i++) {
        line(30, i * 3, 5000);
        arc(30, i * 3 + 3, 0, 1.5, 5000);
        line(0, i * 3 + 3, 5000);
    }
}

static void spiral(void) {
    for (int i = 1; i <= 600; i++) {
        line(0.05 * i * cos(i * 0.15), 0.05 * i * sin(i * 0.15), 6000);
    }
}

// Long and short ones, sharp and blunt, slow and fast.
static void random_walk(void) {
    srand(7);
    for (int i = 0; i < 400; i++) {
        double size = exp(rand() % 1000 * 0.005 - 2.5);
        double angle = rand() % 1000 * 0.00628;
        double feed = rand() % 9 ? 600 + rand() % 5000 : 0;
        place[AXIS_Z] = rand() % 5 ? place[AXIS_Z] : rand() % 100 * 0.05;
        line(place[AXIS_X] + size * cos(angle), place[AXIS_Y] + size * sin(angle), feed);
    }
}

static const struct {
    const char *name;
    void (*run)(void);
} paths[] = {
    {"long line", long_line},     {"short line", short_line}, {"rapids", rapids_and_dwells},
    {"zigzag", zigzag},           {"reversals", reversals},   {"polygon", polygon},
    {"rectangles", rectangles},   {"slots", slots},           {"spiral", spiral},
    {"random walk", random_walk},
};

// ---- Beside the machine -------------------------------------------------------------------------

static void compare(const stepper_axis_t *axes, bool scurve, double tolerance) {
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        bench_start_with(axes, BLOCKS, false);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            place[axis] = 0;
        }
        stepper_estimate_start(&estimate, place);
        uint64_t begin_us = hal_time_us();
        paths[i].run();
        double estimated = stepper_estimate_seconds(&estimate);
        bench_finish(100);
        double taken = (double)(hal_time_us() - begin_us) * 1e-6;
        char text[80];
        snprintf(text, sizeof text, "%s: %.3f s estimated, %.3f s taken", paths[i].name, estimated,
                 taken);
        printf("%s %+.1f %%\n", text, (estimated / taken - 1) * 100);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(tolerance * taken + 0.002, taken, estimated, text);
        bench_check_positions();
        bench_end();
    }
}

static void test_trapezoids_are_within_a_percent(void) {
    corner = STEPPER_CORNER_CONTINUOUS;
    compare(NULL, false, 0.01);
    compare(&quick, false, 0.01);
}

static void test_blends_and_stops_are_within_a_percent(void) {
    corner = STEPPER_CORNER_STOP;
    compare(&quick, false, 0.01);
    corner = STEPPER_CORNER_BLEND;
    blend_mm = 0.1;
    compare(&quick, false, 0.01);
}

static void test_scurves_are_within_10_percent(void) {
    corner = STEPPER_CORNER_CONTINUOUS;
    compare(NULL, true, 0.1);
    compare(&quick, true, 0.1);
}

static void test_a_place_elsewhere_takes_no_time(void) {
    bench_start();
    const double start[AXIS_COUNT] = {1, 2, 3, 4};
    stepper_estimate_start(&estimate, start);
    stepper_estimate_place(&estimate, (const double[AXIS_COUNT]){10, 0, 0, 0});
    TEST_ASSERT_EQUAL_DOUBLE(0, stepper_estimate_seconds(&estimate));
    stepper_estimate_line(&estimate, &(stepper_move_t){.target = {30, 0, 0, 0}, .feed = 600});
    TEST_ASSERT_DOUBLE_WITHIN(0.001, 2 + 0.02, stepper_estimate_seconds(&estimate));
    bench_end();
}

static void test_an_arc_tells_how_far_it_goes(void) {
    bench_start();
    double low[AXIS_COUNT], high[AXIS_COUNT];
    stepper_estimate_start(&estimate, (const double[AXIS_COUNT]){0});
    stepper_arc_t half = {
        .move = {.target = {10, 0, 1, 0}, .feed = 600},
        .plane = {AXIS_X, AXIS_Y},
        .centre = {5, 0},
        .clockwise = true,
        .turns = 1,
    };
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estimate_arc(&estimate, &half, low, high));
    const double lowest[] = {0, 0, 0, 0};
    const double highest[] = {10, 5, 1, 0};
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, lowest[axis], low[axis]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, highest[axis], high[axis]);
    }
    half.centre[0] = 0;
    TEST_ASSERT_EQUAL(ERR_ARC_NO_RADIUS, stepper_estimate_arc(&estimate, &half, low, high));
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_trapezoids_are_within_a_percent);
    RUN_TEST(test_blends_and_stops_are_within_a_percent);
    RUN_TEST(test_scurves_are_within_10_percent);
    RUN_TEST(test_a_place_elsewhere_takes_no_time);
    RUN_TEST(test_an_arc_tells_how_far_it_goes);
    return UNITY_END();
}
