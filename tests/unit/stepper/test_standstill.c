// Hold, stop and the end of a jog come to a standstill on machines of all kinds, in the time that
// their limits ask for: from speed, while accelerating, and when hardly moving.
#include <math.h>
#include <unity.h>

#include "bench.h"
#include "watch.h"

#define SPEED 50.0 // units/s

void setUp(void) {}
void tearDown(void) {}

static const double accelerations[] = {1, 20, 100, 199, 201, 1000, 100000};
static const double jerks[] = {0, 100, 2000, 50000, 1e7, 1e9}; // 0: trapezoid

static void start(double acceleration, double jerk) {
    const stepper_axis_t axis = {.steps_per_unit = 400,
                                 .max_velocity = SPEED * 60,
                                 .max_acceleration = acceleration,
                                 .home_backoff_mm = 3};
    const double no_limits[AXIS_COUNT] = {0};
    bench_start_with(&axis, 32, false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(jerk > 0));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_jerk(jerk > 0 ? jerk : 1000, no_limits));
}

// The longest that a standstill can take: the acceleration is taken back, built up the other way
// and taken back again. Slices of 2 ms and the end, which is a little slower, come on top.
static double braking_s(double acceleration, double jerk) {
    double peak = jerk > 0 ? fmin(acceleration, sqrt(SPEED * jerk)) : 0;
    double ramps_s = jerk > 0 ? 3 * peak / jerk : 0;
    return (SPEED / acceleration + ramps_s) * 1.1 + 0.06;
}

static void call_hold(void) {
    stepper_hold(true);
}

static void call_jog_stop(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_jog_stop());
}

static void begin_move(void) {
    bench_move(1e5, 0, 0, 0, SPEED * 60);
}

static void begin_jog(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_jog(AXIS_X, INFINITY, SPEED * 60));
}

static void check_standstill(const char *what, double limit_s, bool ends) {
    bench_wait_us((uint64_t)(limit_s * 1e6));
    uint64_t steps = watch_pulses(AXIS_X);
    stepper_status_t status;
    stepper_status(&status);
    bench_wait_us(100000);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(steps, watch_pulses(AXIS_X), what);
    TEST_ASSERT_EQUAL_MESSAGE(!ends, status.moving, what);
    TEST_ASSERT_FALSE_MESSAGE(status.stopping || status.jogging, what);
    bench_check_positions();
}

static void check(void (*begin)(void), void (*call)(void), bool ends) {
    for (unsigned a = 0; a < COUNT_OF_ARRAY(accelerations); a++) {
        for (unsigned j = 0; j < COUNT_OF_ARRAY(jerks); j++) {
            double up_s = braking_s(accelerations[a], jerks[j]);
            const double moments_s[] = {0.001, 0.0137, 0.1 * up_s, 0.33 * up_s, up_s + 0.1};
            for (unsigned m = 0; m < COUNT_OF_ARRAY(moments_s); m++) {
                char what[80];
                snprintf(what, sizeof what, "acceleration %g, jerk %g, after %.3f s",
                         accelerations[a], jerks[j], moments_s[m]);
                start(accelerations[a], jerks[j]);
                watch_reset();
                begin();
                bench_wait_us((uint64_t)(moments_s[m] * 1e6));
                call();
                check_standstill(what, up_s, ends);
                stepper_estop();
                bench_end();
            }
        }
    }
}

static void test_hold_comes_to_a_standstill(void) {
    check(begin_move, call_hold, false);
}

static void test_stop_comes_to_a_standstill(void) {
    check(begin_move, stepper_stop, true);
}

static void test_jog_stop_comes_to_a_standstill(void) {
    check(begin_jog, call_jog_stop, true);
}

int main(void) {
    watch_attach(bench_axes);
    UNITY_BEGIN();
    RUN_TEST(test_hold_comes_to_a_standstill);
    RUN_TEST(test_stop_comes_to_a_standstill);
    RUN_TEST(test_jog_stop_comes_to_a_standstill);
    return UNITY_END();
}
