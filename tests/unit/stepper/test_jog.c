// Jogging: where it ends, how long it takes, new targets on the way, and when it is refused. X: 80
// steps/mm, 100 mm/s, 500 mm/s^2.
#include <math.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"

void setUp(void) {}
void tearDown(void) {}

static const double no_axis_limits[AXIS_COUNT] = {0};

static void start(bool scurve) {
    bench_start();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_jerk(10000, no_axis_limits));
}

static void jog(axis_id_t axis, double distance, double feed) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_jog(axis, distance, feed), err_message());
}

static void check_stands_at(axis_id_t axis, double units, double steps_per_unit) {
    TEST_ASSERT_EQUAL_INT32(lround(units * steps_per_unit), stepper_position_steps(axis));
    bench_check_positions();
}

static void test_distance_and_time(void) {
    for (int scurve = 0; scurve < 2; scurve++) {
        start(scurve);
        jog(AXIS_X, 50, 6000);
        stepper_status_t status;
        stepper_status(&status);
        TEST_ASSERT_TRUE(status.jogging && status.moving);
        // 50 mm at 100 mm/s, 0.2 s to get there, with the jerk limit 500 / 10000 s more.
        TEST_ASSERT_FLOAT_WITHIN(0.012f, scurve ? 0.745f : 0.70f, (float)bench_finish(1));
        check_stands_at(AXIS_X, 50, 80);
        jog(AXIS_X, -12.5, 0);
        bench_finish(1);
        check_stands_at(AXIS_X, 37.5, 80);
        jog(AXIS_A, 0.04, 100); // less than half a step of 0.1 degrees
        bench_finish(1);
        check_stands_at(AXIS_A, 0, 10);
        stepper_status(&status);
        TEST_ASSERT_FALSE(status.jogging);
        bench_end();
    }
}

static void test_no_way_is_no_jog(void) {
    start(true);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_X, -1, 1));
    jog(AXIS_X, 1, 6000);
    bench_finish(1);
    jog(AXIS_X, 0, 6000);
    jog(AXIS_X, 0.001, 6000);
    jog(AXIS_X, INFINITY, 6000); // it stands at its limit
    TEST_ASSERT_EQUAL(0, stepper_active());
    jog(AXIS_X, -0.5, 6000);
    bench_finish(1);
    check_stands_at(AXIS_X, 0.5, 80);
    bench_end();
}

static void test_the_queue_goes_on_from_where_a_jog_ended(void) {
    start(true);
    jog(AXIS_Y, 3.3, 3000);
    bench_finish(1);
    bench_move(1, 1, 0, 0, 6000);
    bench_finish(1);
    check_stands_at(AXIS_X, 1, 80);
    check_stands_at(AXIS_Y, 1, 80);
    bench_end();
}

static void test_farther_target_without_a_stop(void) {
    for (int scurve = 0; scurve < 2; scurve++) {
        start(scurve);
        jog(AXIS_X, 30, 6000);
        bench_wait_us(300000); // at 100 mm/s, a little before braking begins
        double here = stepper_position(AXIS_X);
        jog(AXIS_X, 40, 6000);
        double rest = bench_finish(2);
        check_stands_at(AXIS_X, round((here + 40) * 80) / 80, 80);
        // Without a stop: 40 mm at 100 mm/s and half the time of braking.
        TEST_ASSERT_FLOAT_WITHIN(0.02f, scurve ? 0.525f : 0.50f, (float)rest);
        bench_end();
    }
}

static void test_target_behind_turns_round(void) {
    for (int scurve = 0; scurve < 2; scurve++) {
        start(scurve);
        jog(AXIS_X, 100, 6000);
        bench_wait_us(500000);
        double here = stepper_position(AXIS_X);
        jog(AXIS_X, -20, 3000);
        bench_finish(3);
        check_stands_at(AXIS_X, round((here - 20) * 80) / 80, 80);
        bench_end();
    }
}

static void test_targets_at_random(void) {
    srand(5);
    for (int round_no = 0; round_no < 60; round_no++) {
        start(round_no % 2);
        double target = 0;
        for (int i = 0; i < 8; i++) {
            double distance = (rand() % 4000 - 2000) / 100.0;
            target = stepper_position(AXIS_X) + distance;
            jog(AXIS_X, distance, 500 + rand() % 8000);
            bench_wait_us((uint64_t)(rand() % 400000));
        }
        bench_finish(20);
        check_stands_at(AXIS_X, round(target * 80) / 80, 80);
        bench_end();
    }
}

static void test_stop_takes_the_braking_distance(void) {
    for (int scurve = 0; scurve < 2; scurve++) {
        start(scurve);
        jog(AXIS_X, INFINITY, 6000);
        bench_wait_us(1000000);
        double from = stepper_position(AXIS_X);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_jog_stop());
        bench_finish(1);
        // v^2 / 2a, with the jerk limit v a / 2J more, and up to 2 ms at 100 mm/s.
        double braking = stepper_position(AXIS_X) - from;
        double least = scurve ? 12.5 : 10.0;
        TEST_ASSERT_TRUE(braking >= least && braking < least + 0.25);
        bench_check_positions();
        bench_end();
    }
}

static void test_soft_limits_end_a_jog(void) {
    for (int scurve = 0; scurve < 2; scurve++) {
        start(scurve);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_X, -20, 60));
        jog(AXIS_X, INFINITY, 0);
        bench_finish(5);
        check_stands_at(AXIS_X, 60, 80);
        jog(AXIS_X, -1000, 0);
        bench_finish(5);
        check_stands_at(AXIS_X, -20, 80);
        jog(AXIS_X, -1, 0);
        bench_finish(5);
        check_stands_at(AXIS_X, -20, 80);
        bench_end();
    }
}

static void test_another_axis_waits_for_standstill(void) {
    start(true);
    jog(AXIS_X, INFINITY, 6000);
    bench_wait_us(800000);
    jog(AXIS_Y, 5, 6000);
    bench_finish(2);
    check_stands_at(AXIS_Y, 5, 80);
    TEST_ASSERT_TRUE(stepper_position(AXIS_X) > 50);
    bench_end();
}

static void test_refusals(void) {
    start(false);
    bench_move(100, 0, 0, 0, 6000);
    TEST_ASSERT_EQUAL(ERR_JOG_WHILE_ACTIVE, stepper_jog(AXIS_X, 1, 100));
    bench_finish(3);
    jog(AXIS_X, 10, 6000);
    const stepper_move_t move = {.target = {0}, .feed = 600};
    TEST_ASSERT_EQUAL(ERR_JOGGING, stepper_move(&move));
    TEST_ASSERT_EQUAL(ERR_STEPPER_BUSY, stepper_set_home());
    bench_finish(3);
    check_stands_at(AXIS_X, 110, 80);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_EQUAL(ERR_NOT_ARMED, stepper_jog(AXIS_X, 1, 100));
    bench_end();
}

static void test_emergency_stop_in_a_jog(void) {
    start(true);
    jog(AXIS_X, INFINITY, 6000);
    bench_wait_us(500000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_EQUAL(0, stepper_active());
    bench_check_positions();
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_distance_and_time);
    RUN_TEST(test_no_way_is_no_jog);
    RUN_TEST(test_the_queue_goes_on_from_where_a_jog_ended);
    RUN_TEST(test_farther_target_without_a_stop);
    RUN_TEST(test_target_behind_turns_round);
    RUN_TEST(test_targets_at_random);
    RUN_TEST(test_stop_takes_the_braking_distance);
    RUN_TEST(test_soft_limits_end_a_jog);
    RUN_TEST(test_another_axis_waits_for_standstill);
    RUN_TEST(test_refusals);
    RUN_TEST(test_emergency_stop_in_a_jog);
    return UNITY_END();
}
