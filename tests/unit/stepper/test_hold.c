// Feed hold, resume and overrides: standstill in time, nothing lost, limits kept.
#include <math.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"

void setUp(void) {}
void tearDown(void) {}

static void queue_part(void) {
    bench_move(20, 0, 0, 0, 3000);
    bench_move(30, 10, 1, 45, 3000);
    for (int i = 1; i <= 10; i++) {
        bench_move(30 - 0.3 * i, 10 + 0.2 * i, 1, 45, 3000);
    }
    while (stepper_blocks_free() == 0) {
        bench_wait_us(500);
    }
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(100));
    bench_move(0, 0, 0, 0, 6000);
}

static void check_home(void) {
    bench_check_positions();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_EQUAL_INT64(0, bench.motors[axis].position_steps);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_step_gap_ns);
}

static void test_hold_at_any_moment_loses_nothing(void) {
    for (unsigned us = 0; us < 2200000; us += 9970) {
        bench_start();
        queue_part();
        bench_wait_us(us);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
        bench_wait_us(230000); // 100 mm/s at 500 mm/s^2, and what was computed ahead
        uint64_t held_ns = bench.last_step_ns;
        bench_wait_us(300000);
        TEST_ASSERT_EQUAL_UINT64(held_ns, bench.last_step_ns);
        bench_check_positions();
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
        bench_finish(5);
        check_home();
        bench_end();
    }
}

static void test_hold_brakes_within_its_distance(void) {
    bench_start();
    bench_move(200, 0, 0, 0, 6000);
    bench_wait_us(1000000);
    double from = stepper_position(AXIS_X);
    stepper_hold(true);
    bench_wait_us(500000);
    double distance = stepper_position(AXIS_X) - from;
    TEST_ASSERT_TRUE(distance >= 10.0 && distance < 11.8); // v^2 / 2a, and 17 ms computed ahead
    TEST_ASSERT_EQUAL_INT(1, stepper_active());
    stepper_hold(false);
    bench_finish(3);
    TEST_ASSERT_EQUAL_INT32(16000, stepper_position_steps(AXIS_X));
    bench_end();
}

static void test_hold_stops_the_clock_of_a_dwell(void) {
    bench_start();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(500));
    bench_wait_us(100000);
    stepper_hold(true);
    bench_wait_us(2000000);
    TEST_ASSERT_EQUAL_INT(1, stepper_active());
    stepper_hold(false);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.4, bench_finish(1));
    bench_end();
}

static void test_stop_and_emergency_stop_end_a_hold(void) {
    bench_start();
    queue_part();
    bench_wait_us(300000);
    stepper_hold(true);
    bench_wait_us(300000);
    stepper_stop();
    TEST_ASSERT_TRUE(bench_finish(1) < 0.03);
    bench_check_positions();
    bench_move(0, 0, 0, 0, 6000); // not held
    bench_finish(5);
    check_home();
    stepper_hold(true);
    stepper_estop();
    stepper_run(STEPPER_IDLE_HOLD);
    bench_move(1, 0, 0, 0, 6000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_INT32(80, stepper_position_steps(AXIS_X));
    stepper_hold(true);
    stepper_stop(); // at rest
    bench_move(0, 0, 0, 0, 6000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    bench_end();
}

static void test_feed_override_scales_the_feed(void) {
    bench_start();
    stepper_override(50, 100);
    bench_move(100, 0, 0, 0, 3000); // 25 mm/s, ramps of 0.05 s
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 4.05, bench_finish(10));
    stepper_override(200, 100);
    bench_move(0, 0, 0, 0, 6000); // the axis allows no more than 100 mm/s
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 1.2, bench_finish(10));
    stepper_override(200, 25);
    bench_move(100, 0, 0, 0, 0); // rapid at 25 mm/s
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 4.05, bench_finish(10));
    bench_end();
}

// 200 x 0.5 mm at F1500, doubled while queued: as fast as F3000, 2.10 s.
static void test_override_plans_the_queue_anew(void) {
    bench_start_with(NULL, STEPPER_BLOCKS_MAX, false);
    stepper_hold(true);
    for (int i = 1; i <= 200; i++) {
        bench_move(0.5 * i, 0, 0, 0, 1500);
    }
    stepper_override(200, 100);
    stepper_hold(false);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 2.10, bench_finish(10));
    bench_end();
}

static void test_any_overrides_at_any_time_lose_nothing(void) {
    srand(5);
    bench_start();
    for (int i = 0; i < 100; i++) {
        queue_part();
        bench_wait_us((uint64_t)(rand() % 400000));
        stepper_override(STEPPER_OVERRIDE_MIN + rand() % 191, STEPPER_OVERRIDE_MIN + rand() % 91);
    }
    bench_finish(1000);
    check_home();
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_hold_at_any_moment_loses_nothing);
    RUN_TEST(test_hold_brakes_within_its_distance);
    RUN_TEST(test_hold_stops_the_clock_of_a_dwell);
    RUN_TEST(test_stop_and_emergency_stop_end_a_hold);
    RUN_TEST(test_feed_override_scales_the_feed);
    RUN_TEST(test_override_plans_the_queue_anew);
    RUN_TEST(test_any_overrides_at_any_time_lose_nothing);
    return UNITY_END();
}
