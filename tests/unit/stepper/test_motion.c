// Every step counted at the pins: exact ends, exact positions on the way, minimum times, extreme
// scales.
#include <math.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"

void setUp(void) {}
void tearDown(void) {}

static double uniform(double low, double high) {
    return low + (high - low) * rand() / RAND_MAX;
}

static void check_at(double x, double y, double z, double a) {
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(lround(x * 80), stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT32(lround(y * 80), stepper_position_steps(AXIS_Y));
    TEST_ASSERT_EQUAL_INT32(lround(z * 400), stepper_position_steps(AXIS_Z));
    TEST_ASSERT_EQUAL_INT32(lround(a * 10), stepper_position_steps(AXIS_A));
}

static void test_random_moves_end_exactly(void) {
    bench_start();
    srand(1);
    double to[AXIS_COUNT] = {0};
    for (int i = 0; i < 2000; i++) {
        double reach = i % 3 == 0 ? 20.0 : 0.05;
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            to[axis] += rand() % 2 ? uniform(-reach, reach) : 0.0;
        }
        bench_move(to[0], to[1], to[2], to[3], rand() % 4 ? uniform(300, 6000) : 0);
        if (i % 50 == 0) {
            bench_finish(100);
            check_at(to[0], to[1], to[2], to[3]);
        }
    }
    bench_finish(100);
    check_at(to[0], to[1], to[2], to[3]);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_step_gap_ns);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(10000, bench.min_dir_setup_ns);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_dir_hold_ns);
    bench_end();
}

static void test_position_is_exact_at_any_moment(void) {
    bench_start();
    srand(2);
    for (int i = 0; i < 300; i++) {
        bench_move(uniform(-3, 3), uniform(-3, 3), uniform(-1, 1), uniform(-40, 40), 3000);
        bench_wait_us((uint64_t)uniform(1, 30000));
        bench_check_positions();
    }
    bench_finish(100);
    bench_end();
}

static void test_moves_below_a_step_add_up(void) {
    bench_start();
    for (int i = 1; i <= 1000; i++) {
        bench_move(0.01 * i, 0, 0, 0, 3000); // 0.8 steps each
    }
    for (int i = 1; i <= 1000; i++) {
        bench_move(10, 0.001 * i, 0, 0, 3000); // 0.08 steps each: most are joined with the next
    }
    bench_finish(10);
    check_at(10, 1, 0, 0);
    bench_end();
}

// 99 mm at 50 mm/s, two ramps of 0.1 s: 2.10 s.
static void test_short_blocks_in_line_run_as_one(void) {
    bench_start_with(NULL, STEPPER_BLOCKS_MAX, false);
    for (int i = 1; i <= 200; i++) {
        bench_move(0.5 * i, 0, 0, 0, 3000);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 2.10, bench_finish(10));
    bench_end();
}

// 125.66 mm at 50 mm/s with two ramps of 0.1 s: 2.613 s.
static void test_circle_of_chords_keeps_its_feed(void) {
    bench_start_with(NULL, STEPPER_BLOCKS_MAX, false);
    double degree = acos(-1.0) / 180.0;
    for (int i = 1; i <= 360; i++) {
        bench_move(20 * cos(i * degree) - 20, 20 * sin(i * degree), 0, 0, 3000);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 2.613, bench_finish(10));
    bench_end();
}

// Several blocks in each millisecond: the segment ring is full of short segments.
static void test_many_blocks_in_a_slice(void) {
    const stepper_axis_t fast = {
        .steps_per_unit = 80, .max_velocity = 37500, .max_acceleration = 20000};
    for (int turns = 0; turns < 2; turns++) {
        bench_start_with(&fast, STEPPER_BLOCKS_MAX, false);
        stepper_junction(turns ? 10 : 0.02); // with turns: Y back and forth all the time
        for (int i = 1; i <= 1000; i++) {
            bench_move(0.05 * i, turns && i % 2 ? 0.02 : 0, 0, 0, 37500);
        }
        bench_finish(10);
        bench_check_positions();
        TEST_ASSERT_EQUAL_INT32(4000, stepper_position_steps(AXIS_X));
        TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_Y));
        TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_step_gap_ns);
        TEST_ASSERT_GREATER_OR_EQUAL_UINT64(10000, bench.min_dir_setup_ns);
        TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_dir_hold_ns);
        bench_end();
    }
}

static void test_step_rate_is_limited_to_every_second_tick(void) {
    const stepper_axis_t fast = {
        .steps_per_unit = 400, .max_velocity = 12000, .max_acceleration = 5000};
    bench_start_with(&fast, 32, false); // asks for 80 kHz
    bench_move(100, 0, 0, 0, 12000);
    // 100 mm at 125 mm/s with two ramps of 25 ms: 0.825 s.
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0.825, bench_finish(10));
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(40000, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_UINT64(20000, bench.min_step_gap_ns);
    bench_end();
}

static void test_extreme_scales_and_accelerations(void) {
    const double scales[] = {0.01, 1, 80, 10000};
    const double accelerations[] = {1, 50, 100000};
    for (size_t s = 0; s < 4; s++) {
        for (size_t a = 0; a < 3; a++) {
            stepper_axis_t config = {
                .steps_per_unit = scales[s],
                .max_velocity = 60 * 5000 / scales[s], // 5 kHz
                .max_acceleration = accelerations[a],
            };
            bench_start_with(&config, 32, false);
            double step = 1 / scales[s];
            bench_move(step, 0, 0, 0, 0);           // one step
            bench_move(step, -300 * step, 0, 0, 0); // back and forth
            bench_move(step, 0, 0, 0, 0);
            bench_move(101 * step, 100.4 * step, 7 * step, -100 * step, 0);
            bench_finish(100000);
            bench_check_positions();
            TEST_ASSERT_EQUAL_INT32(101, stepper_position_steps(AXIS_X));
            TEST_ASSERT_EQUAL_INT32(100, stepper_position_steps(AXIS_Y));
            TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, bench.min_step_gap_ns);
            bench_end();
        }
    }
}

static void test_ten_metres_slow_and_fast(void) {
    bench_start();
    bench_move(10000, 0, 0, 0, 6000);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 100.2, bench_finish(200));
    // A slow feed far out: the way of a tick is far below the resolution of a float position.
    bench_move(10000.5, 0.25, 0, 0, 60);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, sqrt(0.5 * 0.5 + 0.25 * 0.25) + 0.002, bench_finish(10));
    check_at(10000.5, 0.25, 0, 0);
    bench_end();
}

static void test_very_slow_feed(void) {
    bench_start();
    bench_move(0.5, 10, 0, 0, 10);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, sqrt(100.25) * 6, bench_finish(100));
    check_at(0.5, 10, 0, 0);
    bench_end();
}

static void test_rotary_axis_feeds(void) {
    bench_start();
    bench_move(0, 0, 0, 90, 3600); // alone: degrees/min, 60 deg/s, ramps of 0.03 s
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 1.53, bench_finish(10));
    bench_move(10, 0, 0, 180, 600); // with X: 10 mm/s over the 10 mm of X, A follows
    TEST_ASSERT_DOUBLE_WITHIN(0.06, 1.045, bench_finish(10));
    check_at(10, 0, 0, 180);
    bench_end();
}

static void test_dwell_and_spindle_keep_their_place(void) {
    bench_start();
    uint32_t spindle = pins_mask(BENCH_SPINDLE_GPIO);
    bench_move(1, 0, 0, 0, 600);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_spindle_switch(STEPPER_SPINDLE_CW, 0));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(500));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_spindle_switch(STEPPER_SPINDLE_OFF, 0));
    bench_move(2, 0, 0, 0, 600);
    bench_wait_us(60000);
    TEST_ASSERT_FALSE(hal_pins_read() & spindle); // still moving
    bench_wait_us(200000);
    TEST_ASSERT_TRUE(hal_pins_read() & spindle);
    TEST_ASSERT_EQUAL_INT32(80, stepper_position_steps(AXIS_X)); // dwelling
    bench_finish(2);
    TEST_ASSERT_FALSE(hal_pins_read() & spindle);
    check_at(2, 0, 0, 0);
    bench_end();
}

static void test_drivers_go_off_when_idle_if_wanted(void) {
    bench_start();
    uint32_t enable = pins_mask(4);
    TEST_ASSERT_FALSE(hal_pins_read() & enable);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_DISABLE));
    bench_wait_us(1000);
    TEST_ASSERT_TRUE(hal_pins_read() & enable);
    bench_move(1, 0, 0, 0, 600);
    bench_wait_us(20);
    TEST_ASSERT_FALSE(hal_pins_read() & enable);
    bench_finish(2);
    TEST_ASSERT_TRUE(hal_pins_read() & enable);
    check_at(1, 0, 0, 0);
    bench_end();
}

static void test_configuration_between_moves_keeps_directions_right(void) {
    bench_start();
    bench_move(-2, -2, -2, -2, 600);
    bench_finish(10);
    TEST_ASSERT_EQUAL(ERR_OK, bench_spindle(BENCH_SPINDLE_GPIO, true));
    bench_move(-3, -1, -3, -3, 600);
    bench_finish(10);
    check_at(-3, -1, -3, -3);
    bench_end();
}

static void test_tick_rests_when_there_is_nothing_to_do(void) {
    const stepper_init_t init = {0.05, 32, PINS_NONE, false};
    const stepper_axis_t x = {2, 3, PINS_NONE, false, 80, 6000, 500, 3};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&init));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &x));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    bench_wait_us(1000);
    TEST_ASSERT_FALSE(hal_tick_running());
    bench_move(1, 0, 0, 0, 6000);
    TEST_ASSERT_TRUE(hal_tick_running());
    bench_finish(2);
    TEST_ASSERT_FALSE(hal_tick_running());
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_random_moves_end_exactly);
    RUN_TEST(test_position_is_exact_at_any_moment);
    RUN_TEST(test_moves_below_a_step_add_up);
    RUN_TEST(test_short_blocks_in_line_run_as_one);
    RUN_TEST(test_circle_of_chords_keeps_its_feed);
    RUN_TEST(test_many_blocks_in_a_slice);
    RUN_TEST(test_step_rate_is_limited_to_every_second_tick);
    RUN_TEST(test_extreme_scales_and_accelerations);
    RUN_TEST(test_ten_metres_slow_and_fast);
    RUN_TEST(test_very_slow_feed);
    RUN_TEST(test_rotary_axis_feeds);
    RUN_TEST(test_dwell_and_spindle_keep_their_place);
    RUN_TEST(test_drivers_go_off_when_idle_if_wanted);
    RUN_TEST(test_configuration_between_moves_keeps_directions_right);
    RUN_TEST(test_tick_rests_when_there_is_nothing_to_do);
    return UNITY_END();
}
