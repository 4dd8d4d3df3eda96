// Every way in which homing can end too early: what is said, and that the machine is in order then.
#include <string.h>
#include <unity.h>

#include "homing_bench.h"
#include "host_clock.h"
#include "host_pads.h"

#define PULL_OFF_X (3 * 80) // steps

void setUp(void) {}
void tearDown(void) {
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    stepper_close(); // what a failed test has left
}

static const char *const phases[] = {
    "leaving the switch", "approaching the switch", "backing off", "approaching slowly",
    "pulling off",
};

static simulate_switch_t *const x_min = &homing_switches[SWITCH_X_MIN];

static stepper_status_t get_status(void) {
    stepper_status_t status;
    stepper_status(&status);
    return status;
}

static bool drivers_on(void) {
    return (hal_pins_read() & pins_mask(bench_axes[AXIS_X].enable_gpio)) == 0;
}

static stepper_event_t last_event(void) {
    stepper_event_t last = STEPPER_EVENT_NONE;
    for (stepper_event_t event; (event = stepper_next_event()) != STEPPER_EVENT_NONE;) {
        last = event == STEPPER_EVENT_IDLE ? last : event;
    }
    return last;
}

static void begin(int64_t x) {
    homing_bench_start(false);
    stepper_home_t wanted = {.latch = STEPPER_HOME_LATCH, .max_travel_mm = 60.0};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
    homing_bench_put(AXIS_X, x);
    while (stepper_next_event() != STEPPER_EVENT_NONE) {
    }
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
}

// At rest, counting right, position unknown, and the limit switch does its work.
static void check_in_order(bool armed) {
    stepper_status_t status = get_status();
    TEST_ASSERT_FALSE(status.moving);
    TEST_ASSERT_FALSE(status.stopping);
    TEST_ASSERT_FALSE(status.position_known);
    TEST_ASSERT_EQUAL(armed, status.armed);
    TEST_ASSERT_EQUAL(armed, drivers_on());
    const uint64_t pulses = bench.motors[AXIS_X].pulses;
    bench_wait_us(200000);
    TEST_ASSERT_EQUAL_UINT64(pulses, bench.motors[AXIS_X].pulses);

    x_min->fault = SIMULATE_FAULT_NONE;
    homing_bench_put(AXIS_X, 400);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    while (stepper_next_event() != STEPPER_EVENT_NONE) {
    }
    bench_move(-20, 0, 0, 0, 3000);
    bench_wait_us(2000000);
    TEST_ASSERT_EQUAL(STEPPER_EVENT_LIMIT, last_event());
    TEST_ASSERT_FALSE(get_status().armed);
    TEST_ASSERT_EQUAL_INT64(0, bench.motors[AXIS_X].position_steps); // no step behind the switch

    // And homing starts from there.
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_X].position_steps);
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    bench_end();
}

static void check_failure(const char *said, bool armed) {
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(20));
    TEST_ASSERT_EQUAL_STRING(said, err_message());
    TEST_ASSERT_EQUAL(STEPPER_EVENT_HOMING_FAILED, last_event());
    check_in_order(armed);
}

// ---- The switch ---------------------------------------------------------------------------------

static void test_a_switch_that_never_closes(void) {
    begin(4000);
    x_min->fault = SIMULATE_FAULT_NEVER_CLOSES;
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(20));
    TEST_ASSERT_EQUAL_INT64(4000 - 60 * 80, bench.motors[AXIS_X].position_steps);
    check_failure("Homing X failed: the switch X_MIN never closed within 60 mm while approaching "
                  "the switch",
                  true);
}

static void test_a_switch_that_is_stuck_from_the_start(void) {
    homing_bench_start(false);
    x_min->fault = SIMULATE_FAULT_NEVER_OPENS;
    homing_bench_put(AXIS_X, 4000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    check_failure("Homing X failed: the switch X_MIN did not open within 8 mm while leaving the "
                  "switch",
                  true);
}

// The approach under way ends at a switch that does not open again.
static void stick_when_pressed(void) {
    while (!x_min->pressed) {
        bench_wait_us(10);
        stepper_background();
    }
    x_min->fault = SIMULATE_FAULT_NEVER_OPENS;
}

static void test_a_switch_that_sticks_in_the_first_approach(void) {
    begin(4000);
    homing_bench_reach(AXIS_X, "approaching the switch", 0);
    stick_when_pressed();
    check_failure("Homing X failed: the switch X_MIN did not open within 3 mm while backing off",
                  true);
}

static void test_a_switch_that_breaks_before_the_second_approach(void) {
    begin(4000);
    homing_bench_reach(AXIS_X, "backing off", 0);
    bench_wait_us(60000);
    x_min->fault = SIMULATE_FAULT_NEVER_CLOSES;
    check_failure("Homing X failed: the switch X_MIN never closed within 11 mm while approaching "
                  "slowly",
                  true);
}

static void test_a_switch_that_sticks_in_the_second_approach(void) {
    begin(4000);
    homing_bench_reach(AXIS_X, "approaching slowly", 100000);
    stick_when_pressed();
    check_failure("Homing X failed: the switch X_MIN did not open within 3 mm while pulling off",
                  true);
}

static void test_an_axis_too_far_from_zero(void) {
    homing_bench_start(true);
    stepper_home_t wanted = {.latch = STEPPER_HOME_LATCH, .max_travel_mm = 1000.0};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_position(AXIS_X, -1.0e9 / 80.0 + 500.0));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(20));
    TEST_ASSERT_EQUAL_STRING("Homing X failed: its position is too far from zero for more travel",
                             err_message());
    check_in_order(true);
}

// Both ends on one pin: homing works, but not from a switch that is pressed already, since leaving
// it could be running into the other end.
static void test_a_switch_for_both_ends(void) {
    for (unsigned pressed = 0; pressed < 2; pressed++) {
        homing_bench_start(false);
        homing_bench_put(AXIS_X, pressed ? -100 : 1000);
        stepper_hwlimits_t switches = {.active_high = 0};
        memset(switches.gpio, PINS_NONE, sizeof switches.gpio);
        switches.gpio[STEPPER_X_MIN] = switches.gpio[STEPPER_X_MAX] = 16;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&switches));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        const uint64_t pulses = bench.motors[AXIS_X].pulses;
        if (pressed) {
            TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(20));
            TEST_ASSERT_EQUAL_STRING(
                "Homing X failed: it stands on the switch of either end - jog off it",
                err_message());
            TEST_ASSERT_EQUAL_UINT64(pulses, bench.motors[AXIS_X].pulses);
            check_in_order(true);
        } else {
            TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
            TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_X].position_steps);
            bench_end();
        }
    }
}

// The failure of one axis is told as that of the group's axis that it is.
static void test_of_a_group_the_axis_that_failed_is_named(void) {
    homing_bench_start(false);
    const uint8_t order[] = {3, 0, 0};
    stepper_home_t wanted = {.latch = STEPPER_HOME_LATCH, .max_travel_mm = 80.0};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_order(order));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_Y, &wanted));
    homing_switches[SWITCH_Y_MIN].fault = SIMULATE_FAULT_NEVER_CLOSES;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(3));
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(20));
    TEST_ASSERT_EQUAL_STRING("Homing Y failed: the switch Y_MIN never closed within 80 mm while "
                             "approaching the switch",
                             err_message());
    TEST_ASSERT_EQUAL_INT64(4000 - 80 * 80, bench.motors[AXIS_Y].position_steps);
    homing_switches[SWITCH_Y_MIN].fault = SIMULATE_FAULT_NONE;
    check_in_order(true);
}

// Not taken for the switch: the second approach does not find it.
static void test_a_disturbance_is_no_home_position(void) {
    begin(4000);
    homing_bench_reach(AXIS_X, "approaching the switch", 100000);
    host_pads_drive(x_min->gpio, false);
    bench_wait_us(200);
    host_pads_drive(x_min->gpio, true);
    check_failure("Homing X failed: the switch X_MIN never closed within 11 mm while approaching "
                  "slowly",
                  true);
}

static void test_a_pulse_shorter_than_the_filter_is_nothing(void) {
    begin(4000);
    homing_bench_reach(AXIS_X, "approaching the switch", 100000);
    for (unsigned n = 0; n < 50; n++) {
        bench_wait_us(103);
        host_pads_drive(x_min->gpio, false);
        bench_wait_us(19);
        host_pads_drive(x_min->gpio, true);
    }
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_X].position_steps);
    bench_end();
}

// ---- Stops in every phase -----------------------------------------------------------------------

// Homing from the pressed switch, in the middle of the phase. Whatever the phase takes is enough.
static void begin_in(unsigned phase) {
    static const unsigned more_us[] = {20000, 40000, 30000, 60000, 30000};
    begin(-200);
    homing_bench_reach(AXIS_X, phases[phase], more_us[phase]);
    uint32_t axes;
    TEST_ASSERT_EQUAL_STRING(phases[phase], stepper_homing_phase(&axes));
}

static void test_a_stop_brakes_and_ends_it(void) {
    for (unsigned phase = 0; phase < COUNT_OF_ARRAY(phases); phase++) {
        begin_in(phase);
        stepper_stop();
        char said[80];
        format_text(said, sizeof said, "Homing X stopped while %s", phases[phase]);
        check_failure(said, true);
    }
}

static void test_an_emergency_stop_ends_it_at_once(void) {
    for (unsigned phase = 0; phase < COUNT_OF_ARRAY(phases); phase++) {
        begin_in(phase);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
        TEST_ASSERT_FALSE(drivers_on());
        char said[120];
        format_text(said, sizeof said, "Homing X failed: emergency stop while %s", phases[phase]);
        check_failure(said, false);
    }
}

static void test_the_estop_input_ends_it_at_the_next_tick(void) {
    for (unsigned phase = 0; phase < COUNT_OF_ARRAY(phases); phase++) {
        begin_in(phase);
        host_pads_drive(BENCH_ESTOP_GPIO, false);
        const uint64_t pressed_ns = host_clock_now_ns();
        TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(5));
        char said[80];
        format_text(said, sizeof said, "Homing X failed: E-STOP while %s", phases[phase]);
        TEST_ASSERT_EQUAL_STRING(said, err_message());
        bench_wait_us(100000);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(pressed_ns + 10000, bench.last_step_ns);
        TEST_ASSERT_FALSE(drivers_on());
        TEST_ASSERT_EQUAL(STEPPER_ALARM_ESTOP, stepper_alarm());
        TEST_ASSERT_EQUAL(ERR_ESTOP_ACTIVE, stepper_home(1u << AXIS_X));
        host_pads_drive(BENCH_ESTOP_GPIO, true);
        check_in_order(false);
    }
}

// Those that homing does not go to go on being watched.
static void test_another_limit_switch_trips(void) {
    for (unsigned phase = 0; phase < COUNT_OF_ARRAY(phases); phase++) {
        begin_in(phase);
        host_pads_drive(homing_switches[SWITCH_X_MAX].gpio, false);
        const uint64_t pressed_ns = host_clock_now_ns();
        TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(5));
        char said[100];
        format_text(said, sizeof said, "Homing X failed: Limit switch X_MAX while %s",
                    phases[phase]);
        TEST_ASSERT_EQUAL_STRING(said, err_message());
        bench_wait_us(100000);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(pressed_ns + 40000, bench.last_step_ns);
        TEST_ASSERT_EQUAL(STEPPER_ALARM_LIMIT, stepper_alarm());
        host_pads_drive(homing_switches[SWITCH_X_MAX].gpio, true);
        check_in_order(false);
    }
}

// Homing is under way, and X does not move any more half a second from now on.
static void check_held(void) {
    for (unsigned n = 0; n < 2000; n++) {
        bench_wait_us(250);
        stepper_background();
    }
    const uint64_t pulses = bench.motors[AXIS_X].pulses;
    TEST_ASSERT_EQUAL(STEPPER_CYCLE_HOMING, stepper_cycle());
    bench_wait_us(500000);
    stepper_background();
    TEST_ASSERT_EQUAL_UINT64(pulses, bench.motors[AXIS_X].pulses);
}

static void test_a_feed_hold_waits_and_goes_on(void) {
    for (unsigned phase = 0; phase < COUNT_OF_ARRAY(phases); phase++) {
        begin_in(phase);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
        check_held();
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
        TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_X].position_steps);
        bench_end();
    }
}

// The axis comes to its switch while it brakes for a hold, or a hold comes while it brakes for the
// switch: it stays held in either case.
static void test_a_hold_outlasts_the_switch(void) {
    for (int before_us = -40000; before_us <= 60000; before_us += 20000) {
        begin(4000);
        homing_bench_reach(AXIS_X, "approaching the switch", 300000);
        if (before_us > 0) {
            TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
            bench_wait_us((unsigned)before_us);
        }
        host_pads_drive(x_min->gpio, false);
        bench_wait_us(before_us > 0 ? 200 : 200 - (unsigned)before_us);
        if (before_us <= 0) {
            TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
        }
        check_held();
        uint32_t axes;
        TEST_ASSERT_EQUAL_STRING("approaching the switch", stepper_homing_phase(&axes));
        stepper_stop();
        host_pads_drive(x_min->gpio, true);
        check_failure("Homing X stopped while approaching the switch", true);
    }
}

static void test_close_in_every_phase_leaves_nothing_behind(void) {
    for (unsigned phase = 0; phase < COUNT_OF_ARRAY(phases); phase++) {
        begin_in(phase);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
        TEST_ASSERT_EQUAL(STEPPER_CYCLE_NONE, stepper_cycle());
        TEST_ASSERT_EQUAL(ERR_OK, stepper_cycle_result());
        stepper_background();
        homing_bench_start(true);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
        bench_end();
    }
}

int main(void) {
    UNITY_BEGIN();
    for (unsigned curved = 0; curved < 2; curved++) {
        homing_bench_scurve(curved != 0);
        RUN_TEST(test_a_switch_that_never_closes);
        RUN_TEST(test_a_switch_that_is_stuck_from_the_start);
        RUN_TEST(test_a_switch_that_sticks_in_the_first_approach);
        RUN_TEST(test_a_switch_that_breaks_before_the_second_approach);
        RUN_TEST(test_a_switch_that_sticks_in_the_second_approach);
        RUN_TEST(test_an_axis_too_far_from_zero);
        RUN_TEST(test_a_switch_for_both_ends);
        RUN_TEST(test_of_a_group_the_axis_that_failed_is_named);
        RUN_TEST(test_a_disturbance_is_no_home_position);
        RUN_TEST(test_a_pulse_shorter_than_the_filter_is_nothing);
        RUN_TEST(test_a_stop_brakes_and_ends_it);
        RUN_TEST(test_an_emergency_stop_ends_it_at_once);
        RUN_TEST(test_the_estop_input_ends_it_at_the_next_tick);
        RUN_TEST(test_another_limit_switch_trips);
        RUN_TEST(test_a_feed_hold_waits_and_goes_on);
        RUN_TEST(test_a_hold_outlasts_the_switch);
        RUN_TEST(test_close_in_every_phase_leaves_nothing_behind);
    }
    return UNITY_END();
}
