// Rounded corners: how near they pass, when there is one and when not, and what may happen inside.
#include <math.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"

#define STEPS_PER_MM 80.0

static const stepper_axis_t even = {
    .steps_per_unit = STEPS_PER_MM, .max_velocity = 6000, .max_acceleration = 500};

void setUp(void) {}
void tearDown(void) {}

// Nothing moves yet; what is queued waits for arm().
static void start(uint32_t blocks) {
    bench_start_with(&even, blocks, false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
}

static void arm(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
}

static err_t line(double x, double y, double blend_mm) {
    stepper_move_t move = {
        .target = {x, y, 0, 0},
        .feed = 6000,
        .corner = STEPPER_CORNER_BLEND,
        .blend_mm = blend_mm,
    };
    return stepper_move(&move);
}

static void queue(double x, double y, double blend_mm) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, line(x, y, blend_mm), err_message());
}

static double motor_mm(axis_id_t axis) {
    return (double)bench.motors[axis].position_steps / STEPS_PER_MM;
}

// Runs to the end; returns how near to a corner the motors came, in mm.
static double nearest_to(double x, double y) {
    double nearest = INFINITY;
    while (stepper_active() > 0) {
        bench_wait_us(100);
        nearest = fmin(nearest, hypot(motor_mm(AXIS_X) - x, motor_mm(AXIS_Y) - y));
    }
    bench_check_positions();
    return nearest;
}

static void check_end(double x, double y) {
    TEST_ASSERT_EQUAL_INT32(lround(x * STEPS_PER_MM), stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT32(lround(y * STEPS_PER_MM), stepper_position_steps(AXIS_Y));
}

#define STEP_MM (1.5 / STEPS_PER_MM)

static void test_corner_is_passed_at_the_tolerance(void) {
    const double tolerances[] = {0.05, 0.2, 1.0};
    for (size_t i = 0; i < 3; i++) {
        for (double angle = 0.5; angle < 3.1; angle += 0.5) {
            start(32);
            queue(20, 0, tolerances[i]);
            queue(20 + 20 * cos(angle), 20 * sin(angle), tolerances[i]);
            TEST_ASSERT_EQUAL_UINT32(29, stepper_blocks_free() + 1); // three, and one for the next
            arm();
            TEST_ASSERT_DOUBLE_WITHIN(STEP_MM, tolerances[i], nearest_to(20, 0));
            check_end(20 + 20 * cos(angle), 20 * sin(angle));
            bench_end();
        }
    }
}

// Half of the shorter line is all there is.
static void test_short_lines_limit_the_blend(void) {
    start(32);
    queue(20, 0, 5);
    queue(20, 1, 5);
    queue(40, 1, 5);
    arm();
    TEST_ASSERT_DOUBLE_WITHIN(STEP_MM, 0.5 * sqrt(0.5) * 0.5, nearest_to(20, 0));
    check_end(40, 1);
    bench_end();
}

static void test_no_blend_where_there_is_no_corner(void) {
    start(32);
    queue(10, 0, 0.5);
    queue(20, 0, 0.5);       // straight on
    queue(30, 0.00001, 0.5); // as good as that
    queue(5, 0, 0.5);        // back
    TEST_ASSERT_EQUAL_UINT32(32 - 4 - 1, stepper_blocks_free());
    arm();
    bench_finish(10);
    check_end(5, 0);
    bench_end();
}

// 0.01 rad at 10 mm/s: the speed changes by 0.1 mm/s, which takes 0.2 ms.
static void test_small_corners_at_low_speed_are_passed_as_they_are(void) {
    start(32);
    stepper_move_t move = {.feed = 600, .corner = STEPPER_CORNER_BLEND, .blend_mm = 0.5};
    for (int i = 1; i <= 10; i++) {
        move.target[AXIS_X] = 10 * i;
        move.target[AXIS_Y] = i % 2 ? 0 : 0.05;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_move(&move));
    }
    TEST_ASSERT_EQUAL_UINT32(32 - 10 - 1, stepper_blocks_free());
    bench_end();
}

static void test_corners_with_arcs_and_pauses_are_exact(void) {
    start(32);
    queue(10, 0, 0.5);
    stepper_arc_t arc = {
        .move = {.target = {10, 10, 0, 0},
                 .feed = 600,
                 .corner = STEPPER_CORNER_BLEND,
                 .blend_mm = 1},
        .plane = {AXIS_X, AXIS_Y},
        .centre = {0, 5},
        .turns = 1,
    };
    TEST_ASSERT_EQUAL(ERR_OK, stepper_arc(&arc));
    queue(10, 20, 0.5);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(10));
    queue(20, 20, 0.5);
    TEST_ASSERT_EQUAL_UINT32(32 - 5 - 1, stepper_blocks_free());
    arm();
    TEST_ASSERT_DOUBLE_WITHIN(STEP_MM, 0, nearest_to(10, 10));
    check_end(20, 20);
    bench_end();
}

static void test_a_line_that_has_begun_keeps_its_end(void) {
    start(32);
    arm();
    queue(10, 0, 1);
    bench_wait_us(50000);
    queue(10, 10, 1); // too late for this corner
    queue(0, 10, 1);  // in time
    double first = INFINITY;
    double second = INFINITY;
    while (stepper_active() > 0) {
        bench_wait_us(100);
        first = fmin(first, hypot(motor_mm(AXIS_X) - 10, motor_mm(AXIS_Y)));
        second = fmin(second, hypot(motor_mm(AXIS_X) - 10, motor_mm(AXIS_Y) - 10));
    }
    TEST_ASSERT_DOUBLE_WITHIN(STEP_MM, 0, first);
    TEST_ASSERT_DOUBLE_WITHIN(STEP_MM, 1, second);
    check_end(0, 10);
    bench_end();
}

// The machine is about to stop at the end of what it knows, 2.5 mm ahead, and has 50 mm/s. A corner
// that may be passed at 19 mm/s must not appear 1.5 mm ahead.
static void test_the_end_is_not_changed_at_the_last_moment(void) {
    for (int early = 0; early < 2; early++) {
        start(32);
        queue(30, 0, 1);
        queue(32, 0, 1);
        arm();
        bench_wait_us(early ? 100000 : 420000);
        queue(30.02, 0.1, 1);
        if (!early) {
            TEST_ASSERT_DOUBLE_WITHIN(0.5, 29.5, motor_mm(AXIS_X));
        }
        TEST_ASSERT_DOUBLE_WITHIN(STEP_MM, early ? 0.5 : 0, nearest_to(32, 0));
        check_end(30.02, 0.1);
        bench_end();
    }
}

// Who looks whether there is room before each line is never refused, and neither does the queue run
// over.
static void test_room_that_is_told_is_there(void) {
    for (uint32_t blocks = 1; blocks <= 6; blocks++) {
        start(blocks);
        arm();
        srand(blocks);
        for (int i = 1; i <= 100; i++) {
            while (stepper_blocks_free() == 0) {
                bench_wait_us(777);
            }
            queue(0.5 * i, rand() % 5, 0.1);
        }
        bench_finish(100);
        TEST_ASSERT_EQUAL_INT32(4000, stepper_position_steps(AXIS_X));
        bench_check_positions();
        TEST_ASSERT_EQUAL_UINT32(blocks, stepper_blocks_free());
        bench_end();
    }
}

static void test_a_full_queue_refuses_and_loses_nothing(void) {
    start(8);
    int sent = 0;
    while (line(sent + 1, sent % 2, 0.1) == ERR_OK) {
        sent++;
    }
    TEST_ASSERT_EQUAL_INT(4, sent); // with three blends, and one slot for the next
    arm();
    for (; sent < 60; sent++) {
        while (line(sent + 1, sent % 2, 0.1) != ERR_OK) {
            TEST_ASSERT_EQUAL_STRING("G-code buffer full", err_message());
            bench_wait_us(500);
        }
    }
    bench_finish(100);
    check_end(60, 1);
    bench_end();
}

// At any moment of a zig-zag of blends: stop, go on from there.
static void test_stops_inside_blends_are_exact(void) {
    for (uint64_t after_us = 1000; after_us < 700000; after_us += 7919) {
        start(64);
        for (int i = 1; i <= 20; i++) {
            queue(i, i % 2, 0.3);
        }
        arm();
        bench_wait_us(after_us);
        stepper_stop();
        bench_finish(10);
        bench_check_positions();
        queue(5, 5, 0.3);
        queue(0, 0, 0.3);
        bench_finish(10);
        bench_check_positions();
        check_end(0, 0);
        bench_end();
    }
}

static void test_holds_inside_blends_go_on(void) {
    start(64);
    for (int i = 1; i <= 20; i++) {
        queue(i, i % 2, 0.3);
    }
    arm();
    for (int i = 0; i < 40; i++) {
        bench_wait_us(40000);
        stepper_hold(i % 2 == 0);
        stepper_override(i % 3 == 0 ? 200 : 40, 100);
    }
    stepper_hold(false);
    bench_finish(10);
    check_end(20, 0);
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_corner_is_passed_at_the_tolerance);
    RUN_TEST(test_short_lines_limit_the_blend);
    RUN_TEST(test_no_blend_where_there_is_no_corner);
    RUN_TEST(test_small_corners_at_low_speed_are_passed_as_they_are);
    RUN_TEST(test_corners_with_arcs_and_pauses_are_exact);
    RUN_TEST(test_a_line_that_has_begun_keeps_its_end);
    RUN_TEST(test_the_end_is_not_changed_at_the_last_moment);
    RUN_TEST(test_room_that_is_told_is_there);
    RUN_TEST(test_a_full_queue_refuses_and_loses_nothing);
    RUN_TEST(test_stops_inside_blends_are_exact);
    RUN_TEST(test_holds_inside_blends_go_on);
    return UNITY_END();
}
