// Homing without switches: the output of a driver that has noticed a stall ends motion at once, and
// the place of the stall is the home place.
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "homing_bench.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_tick.h"

#define PULL_OFF_X (3 * 80) // steps
#define DIAG_GPIO 22u
#define TICK_NS 10000u
#ifndef ROUNDS
#define ROUNDS 200u // fewer with sanitizers
#endif

void setUp(void) {}
void tearDown(void) {
    stepper_homing_set_hook(NULL);
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    stepper_close(); // what a failed test has left
}

static simulate_switch_t diag = {.axis = &bench.motors[AXIS_X],
                                 .gpio = DIAG_GPIO,
                                 .from_steps = INT32_MIN,
                                 .to_steps = 0,
                                 .pressed_level = true,
                                 .stall_rate_hz = 1000,
                                 .hold_us = 300};

static struct {
    unsigned on, off;
    uint32_t axes;
} hook;

static err_t check_driver(uint32_t axes) {
    (void)axes;
    return ERR_OK;
}

static stepper_arm_t arm_driver(uint32_t axes, bool on) {
    hook.on += on;
    hook.off += !on;
    hook.axes = axes;
    return STEPPER_ARM_DONE;
}

static const stepper_homing_hook_t driver = {check_driver, arm_driver};

static void configure(double seek, double latch) {
    stepper_home_t wanted = {.seek = seek, .latch = latch, .max_travel_mm = 200.0};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
}

// X runs against its end; the driver's output is active high, only at speed, and pulses.
static void begin(double seek, double latch) {
    static bool attached;
    homing_bench_start(false);
    attached = attached || simulate_switch_attach(&diag);
    host_pads_drive(DIAG_GPIO, false);
    bench.motors[AXIS_X].has_stops = true;
    bench.motors[AXIS_X].stop_low_steps = 0;
    bench.motors[AXIS_X].stop_high_steps = 30000;
    stepper_hwlimits_t switches = {.active_high = 1};
    memset(switches.gpio, PINS_NONE, sizeof switches.gpio);
    switches.gpio[STEPPER_X_MIN] = DIAG_GPIO;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&switches));
    configure(seek, latch);
    memset(&hook, 0, sizeof hook);
    stepper_homing_set_hook(&driver);
}

static bool drivers_on(void) {
    return (hal_pins_read() & pins_mask(bench_axes[AXIS_X].enable_gpio)) == 0;
}

// Armed, drivers on, nothing that anybody would have to acknowledge, and moves go on from there.
static void check_ready(void) {
    stepper_status_t status;
    stepper_status(&status);
    TEST_ASSERT_TRUE(status.armed);
    TEST_ASSERT_FALSE(status.stopping);
    TEST_ASSERT_EQUAL_UINT32(status.blocks, status.blocks_free);
    TEST_ASSERT_EQUAL_UINT32(0, status.underruns);
    TEST_ASSERT_EQUAL(STEPPER_ALARM_NONE, stepper_alarm());
    TEST_ASSERT_TRUE(drivers_on());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    bench_move(2, 0, 0, 0, 3000);
    bench_finish(2);
    TEST_ASSERT_EQUAL_INT32(160, stepper_position_steps(AXIS_X));
}

// The motor stands `pull_off` from its end to the step: none was lost.
static void check_home(void) {
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_X].position_steps);
}

static void home(void) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_home(1u << AXIS_X), err_message());
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(40), err_message());
}

// ---- Where it ends ------------------------------------------------------------------------------

static void check_random_starts(bool scurve) {
    static const double latches[] = {0.0, STEPPER_HOME_LATCH};
    unsigned twice = 0;
    srand(23);
    for (unsigned round = 0; round < ROUNDS; round++) {
        begin(1000.0 + rand() % 5000, latches[round % 2]);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
        bool close = round % 5 == 4;
        bench.motors[AXIS_X].position_steps = close ? 60 + rand() % 30 : 1000 + rand() % 9000;
        home();
        check_home();
        bool again = hook.on == 2; // it was found while the axis accelerated
        TEST_ASSERT_EQUAL_UINT32(again ? 2 : 1, hook.on);
        TEST_ASSERT_EQUAL_UINT32(hook.on, hook.off);
        TEST_ASSERT_EQUAL_UINT32(1u << AXIS_X, hook.axes);
        twice += again;
        check_ready();
        bench_end();
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, twice);
    TEST_ASSERT_LESS_THAN_UINT32(ROUNDS / 2, twice);
}

static void test_200_random_starts_end_at_the_same_step(void) {
    check_random_starts(false);
}

static void test_200_random_starts_with_an_scurve(void) {
    check_random_starts(true);
}

static void go_on_ms(unsigned ms) {
    for (unsigned i = 0; i < ms; i++) {
        bench_wait_us(1000);
        stepper_background();
    }
}

// A driver that has measured nothing yet, or only a slow motor, shows a stall as soon as it is
// asked. That is not believed; and the second time it is not looked at before the axis has its
// speed.
static void test_a_stall_that_is_none_while_it_accelerates(void) {
    static const unsigned after_ms[] = {1, 10, 30, 60, 120};
    for (unsigned i = 0; i < 2 * COUNT_OF_ARRAY(after_ms); i++) {
        begin(3000.0, STEPPER_HOME_LATCH);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(i % 2 != 0));
        bench.motors[AXIS_X].position_steps = 6000;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        for (unsigned approach = 1; approach <= 2; approach++) {
            for (unsigned ms = 0; ms < 3000 && hook.on < approach; ms++) {
                go_on_ms(1);
            }
            TEST_ASSERT_EQUAL_UINT32(approach, hook.on);
            go_on_ms(after_ms[i / 2]);
            host_pads_drive(DIAG_GPIO, true);
            go_on_ms(1);
            host_pads_drive(DIAG_GPIO, false);
        }
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(40), err_message());
        check_home();
        TEST_ASSERT_EQUAL_UINT32(2, hook.on);
        TEST_ASSERT_EQUAL_UINT32(2, hook.off);
        check_ready();
        bench_end();
    }
}

// The output changes at any time between two ticks, also while the axis accelerates.
static void check_last_step(unsigned samples, unsigned after_us) {
    begin(6000.0, 0.0);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_filter(samples, 1));
    bench.motors[AXIS_X].position_steps = 20000;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    homing_bench_reach(AXIS_X, "approaching the switch", 0);
    bench_wait_us(after_us);
    const int64_t at = bench.motors[AXIS_X].position_steps;
    host_pads_drive(DIAG_GPIO, true);
    const uint64_t sampled_ns = host_tick_next_ns() + (samples - 1) * TICK_NS;
    bench_wait_us(15000);
    TEST_ASSERT_TRUE(drivers_on());
    host_pads_drive(DIAG_GPIO, false);
    TEST_ASSERT_LESS_THAN_UINT64(sampled_ns, bench.last_step_ns);
    TEST_ASSERT_INT64_WITHIN(1, at, bench.motors[AXIS_X].position_steps);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(5), err_message());
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    // The place is that of the first sample, which comes within a tick.
    TEST_ASSERT_INT64_WITHIN(1, at + PULL_OFF_X, bench.motors[AXIS_X].position_steps);
    check_ready();
    bench_end();
}

static void test_no_step_from_the_last_sample_on(void) {
    for (unsigned round = 0; round < ROUNDS; round++) {
        check_last_step(1 + round % 4, 3000 + 1237 * round);
    }
}

// As the reference has it: nothing is configured but the input, active high.
static void test_it_needs_no_setting(void) {
    begin(0.0, STEPPER_HOME_LATCH);
    const stepper_home_t nothing = {.latch = STEPPER_HOME_LATCH};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &nothing));
    bench.motors[AXIS_X].position_steps = 3000;
    home();
    check_home();
    TEST_ASSERT_EQUAL_UINT32(1, hook.on);
    bench_end();
}

// ---- With others --------------------------------------------------------------------------------

static const uint8_t together[] = {(1u << AXIS_X) | (1u << AXIS_Y), 0, 0};

// Nothing of Y moves while X runs against its end.
static void test_it_is_homed_alone(void) {
    begin(1500.0, STEPPER_HOME_LATCH);
    stepper_hwlimits_t switches = {.active_high = 1};
    memset(switches.gpio, PINS_NONE, sizeof switches.gpio);
    switches.gpio[STEPPER_X_MIN] = DIAG_GPIO;
    switches.gpio[STEPPER_Y_MIN] = (uint8_t)homing_switches[SWITCH_Y_MIN].gpio;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&switches));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_order(together));
    bench.motors[AXIS_X].position_steps = 3000;
    const uint64_t pulses = bench.motors[AXIS_Y].pulses;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(0));
    homing_bench_reach(AXIS_X, "pulling off", 0);
    TEST_ASSERT_EQUAL_UINT64(pulses, bench.motors[AXIS_Y].pulses);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
    check_home();
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_Y].position_steps);
    bench_end();
}

// A switch that is active high stays closed: there is a second approach, which brakes, as does the
// first one when a latch feed was chosen.
static void check_switch(double latch, bool brakes) {
    begin(6000.0, latch);
    stepper_hwlimits_t switches = {.active_high = 1};
    memset(switches.gpio, PINS_NONE, sizeof switches.gpio);
    bench.motors[AXIS_X].has_stops = false;
    bench.motors[AXIS_X].position_steps = 3000;
    switches.gpio[STEPPER_X_MIN] = (uint8_t)homing_switches[SWITCH_X_MIN].gpio;
    homing_switches[SWITCH_X_MIN].pressed_level = true;
    host_pads_drive(homing_switches[SWITCH_X_MIN].gpio, false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&switches));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    homing_bench_reach(AXIS_X, "backing off", 0);
    TEST_ASSERT_EQUAL(brakes, bench.motors[AXIS_X].position_steps < -10);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
    check_home();
    TEST_ASSERT_EQUAL_UINT32(2, hook.on);
    homing_switches[SWITCH_X_MIN].pressed_level = false;
    check_ready();
    bench_end();
}

static void test_a_switch_that_is_active_high(void) {
    check_switch(STEPPER_HOME_LATCH, false);
    check_switch(300.0, true);
}

// ---- What goes wrong ----------------------------------------------------------------------------

// Below its speed the driver notices nothing: with a slow approach that is a failure, not a wrong
// home position.
static void test_it_fails_with_a_slow_approach(void) {
    begin(1500.0, 60.0);
    bench.motors[AXIS_X].position_steps = 3000;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(30));
    TEST_ASSERT_NOT_NULL(strstr(err_message(), "while approaching slowly"));
    stepper_background();
    TEST_ASSERT_EQUAL_UINT32(2, hook.on);
    TEST_ASSERT_EQUAL_UINT32(2, hook.off);
    bench_end();
}

static void test_the_driver_is_disarmed_after_a_stop(void) {
    begin(1500.0, 0.0);
    bench.motors[AXIS_X].position_steps = 3000;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    homing_bench_reach(AXIS_X, "approaching the switch", 50000);
    TEST_ASSERT_EQUAL_UINT32(1, hook.on);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(5));
    stepper_background();
    TEST_ASSERT_EQUAL_UINT32(1, hook.off);
    bench_end();
}

// The E-STOP input is looked at before, at and behind the tick in which the machine halts.
static void test_the_estop_input_works_around_the_halt(void) {
    for (unsigned after_us = 0; after_us < 400; after_us += 7) {
        begin(6000.0, 0.0);
        bench.motors[AXIS_X].position_steps = 20000;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        homing_bench_reach(AXIS_X, "approaching the switch", 150000);
        host_pads_drive(after_us < 200 ? DIAG_GPIO : BENCH_ESTOP_GPIO, after_us < 200);
        bench_wait_us(after_us % 200);
        host_pads_drive(after_us < 200 ? BENCH_ESTOP_GPIO : DIAG_GPIO, after_us >= 200);
        const uint64_t pressed_ns = host_clock_now_ns();
        TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(5));
        TEST_ASSERT_EQUAL_STRING("Homing X failed: E-STOP while approaching the switch",
                                 err_message());
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(pressed_ns + TICK_NS, bench.last_step_ns);
        TEST_ASSERT_EQUAL(STEPPER_ALARM_ESTOP, stepper_alarm());
        TEST_ASSERT_FALSE(drivers_on());
        host_pads_drive(DIAG_GPIO, false);
        host_pads_drive(BENCH_ESTOP_GPIO, true);
        bench_end();
    }
}

// It is held while it brakes for a hold; what comes behind the stall waits for the user.
static void test_a_hold_outlasts_the_halt(void) {
    for (unsigned after_us = 0; after_us < 60000; after_us += 20000) {
        begin(3000.0, 0.0);
        bench.motors[AXIS_X].position_steps = 20000;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        homing_bench_reach(AXIS_X, "approaching the switch", 300000);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
        bench_wait_us(after_us);
        host_pads_drive(DIAG_GPIO, true);
        bench_wait_us(300);
        host_pads_drive(DIAG_GPIO, false);
        const int64_t at = bench.motors[AXIS_X].position_steps;
        for (unsigned n = 0; n < 2000; n++) {
            bench_wait_us(250);
            stepper_background();
        }
        TEST_ASSERT_EQUAL_INT64(at, bench.motors[AXIS_X].position_steps);
        TEST_ASSERT_EQUAL(STEPPER_CYCLE_HOMING, stepper_cycle());
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
        TEST_ASSERT_EQUAL_INT64(at + PULL_OFF_X, bench.motors[AXIS_X].position_steps);
        check_ready();
        bench_end();
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_200_random_starts_end_at_the_same_step);
    RUN_TEST(test_200_random_starts_with_an_scurve);
    RUN_TEST(test_a_stall_that_is_none_while_it_accelerates);
    RUN_TEST(test_no_step_from_the_last_sample_on);
    RUN_TEST(test_it_needs_no_setting);
    RUN_TEST(test_it_is_homed_alone);
    RUN_TEST(test_a_switch_that_is_active_high);
    RUN_TEST(test_it_fails_with_a_slow_approach);
    RUN_TEST(test_the_driver_is_disarmed_after_a_stop);
    RUN_TEST(test_the_estop_input_works_around_the_halt);
    RUN_TEST(test_a_hold_outlasts_the_halt);
    return UNITY_END();
}
