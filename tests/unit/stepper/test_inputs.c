// Inputs that the tick samples: a limit switch against noise, and a latch that keeps where the
// motors were, at every tick of a motion.
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_tick.h"
#include "stepper/governor.h"
#include "stepper/step_isr.h"
#include "stepper/stepper_safety.h"

#define LIMIT_GPIO 20u
#define OTHER_GPIO 21u
#define PROBE_GPIO 22u
#define PROBE (1u << PROBE_GPIO)
#define TICK_US 10u
#ifndef EVERY_TICKS
#define EVERY_TICKS 1u // fewer with sanitizers
#endif

void setUp(void) {
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    host_pads_drive(LIMIT_GPIO, true);
    host_pads_drive(OTHER_GPIO, true);
    host_pads_drive(PROBE_GPIO, true);
}

void tearDown(void) {}

static void start_with_limits(void) {
    bench_start();
    stepper_hwlimits_t limits = {.active_high = 0};
    memset(limits.gpio, PINS_NONE, sizeof limits.gpio);
    limits.gpio[STEPPER_X_MIN] = LIMIT_GPIO;
    limits.gpio[STEPPER_Y_MAX] = OTHER_GPIO;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&limits));
}

// In the middle between two ticks, so that the number of samples in a time is certain.
static void go_between_ticks(void) {
    TEST_ASSERT_TRUE(hal_tick_running());
    bench_wait_us((host_tick_next_ns() - host_clock_now_ns()) / 1000 + TICK_US / 2);
}

static void pulse(unsigned gpio, unsigned samples) {
    host_pads_drive(gpio, false);
    bench_wait_us(samples * TICK_US);
    host_pads_drive(gpio, true);
}

// Two samples of one input, then at once two of the other: neither has three.
static void test_noise_shorter_than_the_filter_does_not_trip(void) {
    start_with_limits();
    go_between_ticks();
    bench_move(50, 20, 0, 90, 6000);
    for (int i = 0; i < 2000; i++) {
        pulse(i % 3 == 0 ? OTHER_GPIO : LIMIT_GPIO, 1 + (unsigned)i % 2);
        bench_wait_us((1 + (unsigned)i % 5) * TICK_US);
        if (i % 7 == 0) {
            pulse(LIMIT_GPIO, 2);
            pulse(OTHER_GPIO, 2);
            bench_wait_us(TICK_US);
        }
    }
    bench_finish(5);
    TEST_ASSERT_EQUAL(STEPPER_ALARM_NONE, stepper_alarm());
    TEST_ASSERT_EQUAL_INT64(50 * 80, bench.motors[AXIS_X].position_steps);
    bench_check_positions();
    bench_end();
}

// Between two ticks, with this filter.
static void press_at_speed(uint32_t samples) {
    start_with_limits();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_filter(samples, 1));
    bench_move(500, 0, 0, 0, 6000);
    bench_wait_us(500000);
    go_between_ticks();
    host_pads_drive(OTHER_GPIO, false);
}

// The step pins rise `samples - 1` more times at most.
static void check_trip(uint32_t samples) {
    press_at_speed(samples);
    bench_wait_us(samples * TICK_US - TICK_US / 2 - 1);
    TEST_ASSERT_TRUE(hal_tick_running());
    bench_wait_us(2);
    TEST_ASSERT_FALSE(hal_tick_running());
    bench_wait_us(10000);
    TEST_ASSERT_EQUAL(STEPPER_ALARM_LIMIT, stepper_alarm());
    stepper_trip_t trip;
    stepper_last_trip(&trip);
    TEST_ASSERT_EQUAL_UINT32(1u << STEPPER_Y_MAX, trip.switches);
    TEST_ASSERT_FALSE(trip.estop);
    TEST_ASSERT_TRUE(trip.position_lost);
    bench_check_positions();
    host_pads_drive(OTHER_GPIO, true);
    bench_end();
}

static void test_a_limit_trips_with_the_last_sample_of_its_filter(void) {
    check_trip(1);
    check_trip(2);
    check_trip(3);
    check_trip(17);
    check_trip(100);
}

static void check_last_step(uint32_t samples) {
    press_at_speed(samples);
    uint64_t last_ns = host_clock_now_ns() + samples * TICK_US * 1000u;
    bench_wait_us(10000);
    TEST_ASSERT_LESS_THAN_UINT64(last_ns - 5000, bench.last_step_ns); // none in the last sample
    TEST_ASSERT_GREATER_THAN_UINT64(last_ns - 200000, bench.last_step_ns);
    host_pads_drive(OTHER_GPIO, true);
    bench_end();
}

static void test_no_step_from_the_last_sample_on(void) {
    check_last_step(1);
    check_last_step(3);
    check_last_step(50);
}

static void test_estop_has_a_filter_of_its_own_if_wanted(void) {
    start_with_limits();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_filter(3, 5));
    go_between_ticks();
    for (unsigned samples = 1; samples < 5; samples++) {
        pulse(BENCH_ESTOP_GPIO, samples);
        bench_wait_us(50);
        TEST_ASSERT_EQUAL(STEPPER_ALARM_NONE, stepper_alarm());
    }
    pulse(BENCH_ESTOP_GPIO, 5);
    TEST_ASSERT_EQUAL(STEPPER_ALARM_ESTOP, stepper_alarm());
    bench_end();
}

// ---- Latch --------------------------------------------------------------------------------------

// A way with ramps, corners, reversals and a dwell: some 3300 ticks.
static void queue_way(void) {
    bench_move(0.3, 0.1, 0.02, 1, 6000);
    bench_move(-0.2, 0.3, -0.01, 3, 6000);
    bench_move(-0.2, 0.3, -0.02, -2, 6000);
    stepper_dwell(1);
    bench_move(0.4, -0.1, 0, 0, 6000);
}

static void arm(uint32_t samples, uint32_t halts) {
    hal_governor_lock();
    step_isr_latch_arm(&(step_isr_latch_t){.pins = PROBE, .samples = samples, .halts = halts});
    hal_governor_unlock();
}

static bool latched(int32_t steps[AXIS_COUNT]) {
    uint32_t pins;
    hal_governor_lock();
    bool yes = step_isr_latched(steps, &pins);
    hal_governor_unlock();
    TEST_ASSERT_EQUAL_UINT32(yes ? PROBE : 0, pins);
    return yes;
}

// A move from where it stands is made in full.
static void check_moves_on(void) {
    const int64_t x = bench.motors[AXIS_X].position_steps;
    double here[AXIS_COUNT];
    stepper_target(here);
    bench_move(here[0] + 1, here[1], here[2], here[3], 6000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_INT64(x + 80, bench.motors[AXIS_X].position_steps);
}

static void check_latch_at(unsigned tick, uint32_t samples) {
    bench_start();
    hal_pin_input(PROBE_GPIO, HAL_PULL_UP);
    queue_way();
    arm(samples, 0);
    go_between_ticks();
    if (tick > samples) {
        bench_wait_us((tick - samples) * TICK_US);
        pulse(PROBE_GPIO, samples - 1); // not long enough
        bench_wait_us(TICK_US);
    } else {
        bench_wait_us(tick * TICK_US);
    }
    int32_t expected[AXIS_COUNT], steps[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        expected[axis] = (int32_t)bench.motors[axis].position_steps;
    }
    TEST_ASSERT_FALSE(latched(steps));
    host_pads_drive(PROBE_GPIO, false);
    bench_wait_us(samples * TICK_US);
    TEST_ASSERT_TRUE(latched(steps));
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, steps, AXIS_COUNT);
    bench_finish(2);
    bench_wait_us(3000);
    TEST_ASSERT_TRUE(latched(steps)); // it stays
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, steps, AXIS_COUNT);
    bench_check_positions();
    TEST_ASSERT_EQUAL_UINT32(STEPPER_BLOCKS_DEFAULT, stepper_blocks_free());
    check_moves_on();
    hal_governor_lock();
    step_isr_latch_disarm();
    hal_governor_unlock();
    host_pads_drive(PROBE_GPIO, true);
    bench_end();
}

static void test_a_latch_keeps_the_position_of_its_first_sample_at_every_tick(void) {
    for (unsigned tick = 0; tick < 3400; tick += EVERY_TICKS) {
        check_latch_at(tick, 1 + tick % 5);
    }
}

static void test_the_longest_filter_of_a_latch(void) {
    for (unsigned tick = 20; tick < 3400; tick += 7 * EVERY_TICKS) {
        check_latch_at(tick, STEP_ISR_LATCH_SAMPLES_MAX);
    }
}

static void test_a_latch_at_rest(void) {
    bench_start();
    hal_pin_input(PROBE_GPIO, HAL_PULL_UP);
    bench_move(1, 2, 0, 0, 6000);
    bench_finish(1);
    bench_wait_us(3000);
    arm(3, 0);
    bench_wait_us(100);
    host_pads_drive(PROBE_GPIO, false);
    bench_wait_us(100);
    int32_t steps[AXIS_COUNT];
    TEST_ASSERT_TRUE(latched(steps));
    TEST_ASSERT_EQUAL_INT32(80, steps[AXIS_X]);
    TEST_ASSERT_EQUAL_INT32(160, steps[AXIS_Y]);
    // Armed again with the contact made: at once.
    arm(3, 0);
    TEST_ASSERT_FALSE(latched(steps));
    bench_wait_us(50);
    TEST_ASSERT_TRUE(latched(steps));
    host_pads_drive(PROBE_GPIO, true);
    bench_end();
}

// ---- Halt ---------------------------------------------------------------------------------------

static void take_motors(int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = (int32_t)bench.motors[axis].position_steps;
    }
}

static bool driver_on(void) {
    return (hal_pins_read() & pins_mask(bench_axes[AXIS_X].enable_gpio)) == 0;
}

// Armed, at rest where the pins say, drivers on; and a move goes on from there.
static void check_standing(void) {
    stepper_status_t status;
    stepper_status(&status);
    TEST_ASSERT_TRUE(status.armed);
    TEST_ASSERT_FALSE(status.moving);
    TEST_ASSERT_EQUAL(STEPPER_ALARM_NONE, stepper_alarm());
    TEST_ASSERT_TRUE(driver_on());
    TEST_ASSERT_TRUE(hal_tick_running()); // E-STOP is watched
    TEST_ASSERT_EQUAL_UINT32(STEPPER_BLOCKS_DEFAULT, stepper_blocks_free());
    bench_check_positions();
    check_moves_on();
    bench_check_positions();
}

// With `locked` the main loop holds the governor off, as it does for microseconds, and does what
// starts the tick: no step comes of it.
static void check_halt_at(unsigned tick, uint32_t samples, bool locked) {
    bench_start();
    hal_pin_input(PROBE_GPIO, HAL_PULL_UP);
    queue_way();
    arm(samples, PROBE);
    go_between_ticks();
    bench_wait_us(tick * TICK_US);
    int32_t expected[AXIS_COUNT], steps[AXIS_COUNT];
    take_motors(expected);
    host_pads_drive(PROBE_GPIO, false);
    if (locked) {
        hal_governor_lock();
    }
    uint64_t last_ns = host_clock_now_ns() + samples * TICK_US * 1000u - 5000;
    bench_wait_us(samples * TICK_US);
    if (locked) {
        TEST_ASSERT_FALSE(hal_tick_running());
        host_pads_drive(PROBE_GPIO, true);
        hal_tick_start();
        bench_wait_us(50);
        TEST_ASSERT_FALSE(hal_tick_running());
        hal_governor_unlock();
    }
    TEST_ASSERT_TRUE(latched(steps));
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, steps, AXIS_COUNT);
    bench_wait_us(3000);
    TEST_ASSERT_LESS_THAN_UINT64(last_ns, bench.last_step_ns); // none in the last sample
    check_standing();
    hal_governor_lock();
    step_isr_latch_disarm();
    hal_governor_unlock();
    host_pads_drive(PROBE_GPIO, true);
    bench_end();
}

static void test_a_latch_that_halts_at_every_tick(void) {
    for (unsigned tick = 0; tick < 3300; tick += EVERY_TICKS) {
        check_halt_at(tick, 1 + tick % 5, tick % 3 == 0);
    }
}

static void test_a_latch_that_halts_at_rest(void) {
    for (unsigned samples = 1; samples < 4; samples++) {
        bench_start();
        hal_pin_input(PROBE_GPIO, HAL_PULL_UP);
        bench_move(1, 2, 0, 0, 6000);
        bench_finish(1);
        host_pads_drive(PROBE_GPIO, false);
        arm(samples, PROBE);
        bench_move(3, 2, 0, 0, 6000); // its first segments are there before the tick
        bench_wait_us(5000);
        int32_t steps[AXIS_COUNT];
        TEST_ASSERT_TRUE(latched(steps));
        TEST_ASSERT_EQUAL_INT32(80, steps[AXIS_X]);
        TEST_ASSERT_EQUAL_INT32(160, steps[AXIS_Y]);
        TEST_ASSERT_EQUAL_INT64(80, bench.motors[AXIS_X].position_steps);
        check_standing();
        host_pads_drive(PROBE_GPIO, true);
        bench_end();
    }
}

// A limit switch that has opened again before the governor could come.
static void test_a_trip_lasts_though_the_tick_is_started(void) {
    for (unsigned after_us = 0; after_us < 20000; after_us += 1300) {
        start_with_limits();
        bench_move(500, 0, 0, 0, 6000);
        bench_wait_us(100000 + after_us);
        go_between_ticks();
        hal_governor_lock();
        pulse(LIMIT_GPIO, 3);
        TEST_ASSERT_FALSE(hal_tick_running());
        const uint64_t last_ns = bench.last_step_ns;
        hal_tick_start();
        bench_wait_us(400);
        TEST_ASSERT_EQUAL_UINT64(last_ns, bench.last_step_ns);
        hal_governor_unlock();
        bench_wait_us(3000);
        TEST_ASSERT_EQUAL_UINT64(last_ns, bench.last_step_ns);
        TEST_ASSERT_EQUAL(STEPPER_ALARM_LIMIT, stepper_alarm());
        bench_check_positions();
        bench_end();
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_noise_shorter_than_the_filter_does_not_trip);
    RUN_TEST(test_a_limit_trips_with_the_last_sample_of_its_filter);
    RUN_TEST(test_no_step_from_the_last_sample_on);
    RUN_TEST(test_estop_has_a_filter_of_its_own_if_wanted);
    RUN_TEST(test_a_latch_keeps_the_position_of_its_first_sample_at_every_tick);
    RUN_TEST(test_the_longest_filter_of_a_latch);
    RUN_TEST(test_a_latch_at_rest);
    RUN_TEST(test_a_latch_that_halts_at_every_tick);
    RUN_TEST(test_a_latch_that_halts_at_rest);
    RUN_TEST(test_a_trip_lasts_though_the_tick_is_started);
    return UNITY_END();
}
