// Rates and accelerations over all that may be configured: every step is made, at most 50,000 a
// second.
#include <math.h>
#include <unity.h>

#include "bench.h"

void setUp(void) {}
void tearDown(void) {}

// Of what STEPPER AXIS takes, 1e7 units/min.
#define VELOCITY_MAX 1e7

typedef struct {
    double scale, acceleration, rate_hz;
} point_t;

// X makes so many steps that it reaches its rate, if that takes less than some seconds.
static double steps_for(const point_t *at) {
    double acceleration_hz2 = at->acceleration * at->scale;
    double to_the_rate = at->rate_hz * at->rate_hz / acceleration_hz2;
    double within_4_s = 4.0 * acceleration_hz2;
    double steps = fmin(fmin(to_the_rate * 1.5, within_4_s) + 50, 20000);
    return fmin(steps, fmax(4 * at->rate_hz, 4));
}

static double duration_s(double steps, const point_t *at) {
    double acceleration_hz2 = at->acceleration * at->scale;
    double top = fmin(at->rate_hz, sqrt(steps * acceleration_hz2));
    return steps / top + top / acceleration_hz2;
}

// Ahead with all axes, back with two of them, and a step.
static void check(const point_t *at) {
    char text[80];
    snprintf(text, sizeof text, "%g steps/unit, %g units/s2, %g Hz", at->scale, at->acceleration,
             at->rate_hz);
    const stepper_axis_t config = {
        .steps_per_unit = at->scale,
        .max_velocity = at->rate_hz * 60 / at->scale,
        .max_acceleration = at->acceleration,
    };
    bench_start_with(&config, 32, false);
    double steps = round(steps_for(at));
    double unit = 1 / at->scale;
    bench_move(steps * unit, 0, 0, 0, 0);
    double taken_s = bench_finish(1000);
    bench_move(steps * unit, round(steps * 0.7) * unit, -round(steps * 0.4) * unit, unit, 0);
    bench_move(0, round(steps * 0.7) * unit, 0, 0, 0);
    bench_move(unit, round(steps * 0.7) * unit, 0, 0, 0);
    bench_finish(1000);
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32_MESSAGE(1, stepper_position_steps(AXIS_X), text);
    TEST_ASSERT_EQUAL_INT32_MESSAGE(lround(steps * 0.7), stepper_position_steps(AXIS_Y), text);
    TEST_ASSERT_EQUAL_INT32_MESSAGE(0, stepper_position_steps(AXIS_Z), text);
    TEST_ASSERT_EQUAL_INT32_MESSAGE(0, stepper_position_steps(AXIS_A), text);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64_MESSAGE(20000, bench.min_step_gap_ns, text);
    double ideal_s = duration_s(steps, at);
    TEST_ASSERT_TRUE_MESSAGE(taken_s <= ideal_s * 1.01 + 0.002, text);
    bench_end();
}

static void test_no_step_is_lost_in_a_sweep(void) {
    const double scales[] = {0.01, 0.7, 80, 10000};
    const double accelerations[] = {1, 30, 3000, 100000};
    const double rates_hz[] = {1, 777.7, 24999, 49999, 50000};
    int points = 0;
    for (size_t s = 0; s < COUNT_OF_ARRAY(scales); s++) {
        for (size_t a = 0; a < COUNT_OF_ARRAY(accelerations); a++) {
            for (size_t r = 0; r < COUNT_OF_ARRAY(rates_hz); r++) {
                point_t at = {scales[s], accelerations[a], rates_hz[r]};
                if (at.rate_hz * 60 / at.scale <= VELOCITY_MAX) {
                    check(&at);
                    points++;
                }
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(68, points);
}

// More than the limit is asked for: the path is slower as a whole, and nothing is missing.
static void test_rates_beyond_the_limit_slow_the_path_down(void) {
    const stepper_axis_t config = {
        .steps_per_unit = 1000, .max_velocity = 6000, .max_acceleration = 2000};
    bench_start_with(&config, 32, false); // 100 kHz
    bench_move(50, 25, 0, 0, 6000);
    // 50,000 steps of X at 50 kHz: 1 s; ramps along the diagonal of 0.025 s.
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.025, bench_finish(10));
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(50000, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT32(25000, stepper_position_steps(AXIS_Y));
    TEST_ASSERT_EQUAL_UINT64(20000, bench.min_step_gap_ns);
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_no_step_is_lost_in_a_sweep);
    RUN_TEST(test_rates_beyond_the_limit_slow_the_path_down);
    return UNITY_END();
}
