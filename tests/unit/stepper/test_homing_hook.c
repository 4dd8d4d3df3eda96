// The hook that arms drivers for homing: nothing moves while it is busy, its failure is that of the
// cycle, and however a cycle ends, what was to be armed is disarmed.
#include <string.h>
#include <unity.h>

#include "homing_bench.h"
#include "host_pads.h"

#define CALLS_MAX 64u
#define NEVER UINT32_MAX

// A driver that takes its time. `calls` are those that it answered with something else than busy.
static struct {
    uint32_t busy_us; // for so long from when it is asked for something else
    unsigned fails;   // the call that does
    uint64_t since_us;
    uint32_t asked; // axes, and bit 31: on
    unsigned busy;
    unsigned calls;
    uint32_t history[CALLS_MAX];
    bool refuses;
    int64_t stood_at; // X, when it was asked
    bool moved;       // while it was busy
    bool is_armed;
    bool armed_behind; // it was asked to arm while there was no cycle
} driver;

#define ON (1u << 31)

static err_t check(uint32_t axes) {
    return driver.refuses ? err_raise(ERR_ARGUMENT, "the driver of axes %u", (unsigned)axes)
                          : ERR_OK;
}

static stepper_arm_t answer(bool on) {
    driver.history[driver.calls++ % CALLS_MAX] = driver.asked;
    driver.asked = 0;
    if (driver.calls - 1 == driver.fails) {
        err_raise(ERR_ARGUMENT, "no answer from the driver");
        return STEPPER_ARM_FAILED;
    }
    driver.is_armed = on;
    return STEPPER_ARM_DONE;
}

static stepper_arm_t arm(uint32_t axes, bool on) {
    const int64_t at = bench.motors[AXIS_X].position_steps;
    const uint32_t asked = axes | (on ? ON : 0);
    driver.armed_behind |= on && stepper_cycle() == STEPPER_CYCLE_NONE;
    if (driver.asked != asked) {
        driver.asked = asked;
        driver.since_us = hal_time_us();
        driver.stood_at = at;
    }
    driver.moved |= at != driver.stood_at;
    if (hal_time_us() - driver.since_us < driver.busy_us) {
        driver.busy++;
        return STEPPER_ARM_BUSY;
    }
    return answer(on);
}

static const stepper_homing_hook_t hook = {check, arm};

void setUp(void) {
    memset(&driver, 0, sizeof driver);
    driver.fails = NEVER;
    driver.busy_us = 5000;
}

void tearDown(void) {
    TEST_ASSERT_FALSE(driver.moved);
    TEST_ASSERT_FALSE(driver.armed_behind);
    stepper_homing_set_hook(NULL);
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    stepper_close(); // what a failed test has left
}

static void begin(void) {
    homing_bench_start(false);
    stepper_homing_set_hook(&hook);
}

static void begin_homing(void) {
    begin();
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_home(1u << AXIS_X), err_message());
}

// Until the hook has been called so often and is busy with the next call.
static void reach(unsigned calls) {
    const unsigned busy = driver.busy;
    for (unsigned n = 0; driver.calls < calls || driver.asked == 0; n++) {
        TEST_ASSERT_TRUE_MESSAGE(n < 400000, "the hook is not called");
        bench_wait_us(250);
        stepper_background();
    }
    TEST_ASSERT_GREATER_THAN_UINT(busy, driver.busy);
}

static void wait_ms(unsigned ms) {
    for (unsigned n = 0; n < 4 * ms; n++) {
        bench_wait_us(250);
        stepper_background();
    }
}

// What was armed has been disarmed, by the last call.
static void check_disarmed(void) {
    wait_ms(20);
    TEST_ASSERT_FALSE(driver.is_armed);
    TEST_ASSERT_EQUAL_UINT32(0, driver.asked);
    TEST_ASSERT_BITS_LOW(ON, driver.history[driver.calls - 1]);
    const unsigned calls = driver.calls;
    wait_ms(20);
    TEST_ASSERT_EQUAL_UINT(calls, driver.calls);
}

static void home_again(void) {
    driver.fails = NEVER;
    if (stepper_alarm() == STEPPER_ALARM_NONE) {
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_run(STEPPER_IDLE_HOLD), err_message());
    }
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_home(1u << AXIS_X), err_message());
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(40), err_message());
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    check_disarmed();
    bench_end();
}

// ---- As it should be ----------------------------------------------------------------------------

static void test_it_is_called_around_each_approach(void) {
    const uint32_t x = 1u << AXIS_X;
    const uint32_t wanted[] = {x | ON, x, x | ON, x};
    for (unsigned busy_us = 0; busy_us < 20000; busy_us += 3333) {
        setUp();
        driver.busy_us = busy_us;
        begin_homing();
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(40), err_message());
        TEST_ASSERT_EQUAL_UINT(4, driver.calls);
        TEST_ASSERT_EQUAL_UINT32_ARRAY(wanted, driver.history, 4);
        TEST_ASSERT_EQUAL(busy_us > 0, driver.busy > 0);
        check_disarmed();
        TEST_ASSERT_EQUAL_UINT(4, driver.calls);
        TEST_ASSERT_FALSE(driver.moved);
        bench_end();
    }
}

static void test_each_group_has_its_own_calls(void) {
    static const uint8_t groups[] = {(1u << AXIS_X) | (1u << AXIS_Y), 1u << AXIS_Z, 0};
    const uint32_t wanted[] = {3 | ON, 3, 3 | ON, 3, 4 | ON, 4, 4 | ON, 4};
    begin();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_order(groups));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(0));
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(60), err_message());
    TEST_ASSERT_EQUAL_UINT(8, driver.calls);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(wanted, driver.history, 8);
    bench_end();
}

// Before anything moves or is lost.
static void test_a_refusal_changes_nothing(void) {
    begin();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    driver.refuses = true;
    const uint64_t pulses = bench.motors[AXIS_X].pulses;
    TEST_ASSERT_EQUAL(ERR_ARGUMENT, stepper_home(1u << AXIS_X));
    TEST_ASSERT_EQUAL_STRING("the driver of axes 1", err_message());
    TEST_ASSERT_EQUAL(ERR_ARGUMENT, stepper_home(0));
    TEST_ASSERT_EQUAL_STRING("the driver of axes 7", err_message());
    wait_ms(20);
    TEST_ASSERT_EQUAL(STEPPER_CYCLE_NONE, stepper_cycle());
    TEST_ASSERT_EQUAL_UINT64(pulses, bench.motors[AXIS_X].pulses);
    TEST_ASSERT_TRUE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    TEST_ASSERT_EQUAL_UINT(0, driver.calls);
    bench_end();
}

// ---- Failures -----------------------------------------------------------------------------------

// The first four calls: arm, disarm, arm, disarm.
static void test_each_call_may_fail(void) {
    static const char *const doing[] = {"approaching the switch", "backing off",
                                        "approaching slowly", "pulling off"};
    for (unsigned fails = 0; fails < 4; fails++) {
        setUp();
        driver.fails = fails;
        begin_homing();
        homing_bench_reach(AXIS_X, doing[fails], 0);
        TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(40));
        TEST_ASSERT_EQUAL_STRING("Homing X failed: no answer from the driver", err_message());
        TEST_ASSERT_FALSE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
        err_raise(ERR_SYNTAX, NULL);
        TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, stepper_cycle_result());
        TEST_ASSERT_EQUAL_STRING("Homing X failed: no answer from the driver", err_message());
        wait_ms(20);
        // What could not be armed is disarmed; what could not be disarmed has been told.
        TEST_ASSERT_EQUAL_UINT(fails % 2 == 0 ? fails + 2 : fails + 1, driver.calls);
        TEST_ASSERT_BITS_LOW(ON, driver.history[driver.calls - 1]);
        home_again();
    }
}

// It is the hook that has to tell it; the cycle's own error stays.
static void test_disarming_may_fail_behind_the_end(void) {
    driver.fails = 1;
    begin_homing();
    homing_bench_reach(AXIS_X, "approaching the switch", 50000);
    stepper_stop();
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(5));
    wait_ms(20);
    TEST_ASSERT_EQUAL_UINT(2, driver.calls);
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, stepper_cycle_result());
    TEST_ASSERT_EQUAL_STRING("Homing X stopped while approaching the switch", err_message());
    home_again();
}

// ---- Stops --------------------------------------------------------------------------------------

typedef enum { BY_STOP, BY_ESTOP, BY_INPUT, BY_CLOSE, WAYS } way_t;

static void stop(way_t way) {
    switch (way) {
    case BY_STOP:
        stepper_stop();
        break;
    case BY_ESTOP:
        TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
        break;
    case BY_INPUT:
        host_pads_drive(BENCH_ESTOP_GPIO, false);
        break;
    default:
        TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
        break;
    }
}

// While the hook is busy with its first, second, third or fourth call.
static void test_stops_while_it_is_busy(void) {
    for (unsigned calls = 0; calls < 4; calls++) {
        for (way_t way = BY_STOP; way < WAYS; way++) {
            setUp();
            begin_homing();
            reach(calls);
            const uint64_t pulses = bench.motors[AXIS_X].pulses;
            stop(way);
            wait_ms(1);
            TEST_ASSERT_EQUAL(STEPPER_CYCLE_NONE, stepper_cycle());
            TEST_ASSERT_EQUAL(way == BY_CLOSE ? ERR_OK : ERR_HOMING_FAILED, stepper_cycle_result());
            check_disarmed();
            TEST_ASSERT_EQUAL_UINT64(pulses, bench.motors[AXIS_X].pulses);
            TEST_ASSERT_FALSE(driver.moved);
            host_pads_drive(BENCH_ESTOP_GPIO, true);
            if (way != BY_CLOSE) {
                home_again();
            }
        }
    }
}

static void test_stops_while_it_is_armed(void) {
    for (way_t way = BY_STOP; way < WAYS; way++) {
        setUp();
        begin_homing();
        homing_bench_reach(AXIS_X, "approaching the switch", 50000);
        TEST_ASSERT_TRUE(driver.is_armed);
        stop(way);
        wait_ms(300); // a stop brakes
        check_disarmed();
        TEST_ASSERT_EQUAL_UINT(2, driver.calls);
        host_pads_drive(BENCH_ESTOP_GPIO, true);
        if (way != BY_CLOSE) {
            home_again();
        }
    }
}

// What the first cycle has left armed is disarmed before the second one arms.
static void test_a_new_cycle_waits_for_the_end_of_the_last(void) {
    const uint32_t x = 1u << AXIS_X;
    const uint32_t z = 1u << AXIS_Z;
    const uint32_t wanted[] = {x | ON, x, z | ON, z, z | ON, z};
    begin_homing();
    reach(0);
    wait_ms(10);
    stepper_stop();
    driver.busy_us = 100000;
    for (unsigned n = 0; stepper_cycle() != STEPPER_CYCLE_NONE; n++) {
        wait_ms(1);
        TEST_ASSERT_LESS_THAN_UINT(1000, n);
    }
    TEST_ASSERT_EQUAL_UINT(1, driver.calls);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_home(z), err_message());
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(40), err_message());
    TEST_ASSERT_EQUAL_UINT(6, driver.calls);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(wanted, driver.history, 6);
    bench_end();
}

// Then it is that cycle's error.
static void test_what_is_left_may_fail_in_a_new_cycle(void) {
    begin_homing();
    reach(0);
    wait_ms(10);
    stepper_stop();
    driver.busy_us = 300000;
    driver.fails = 1;
    wait_ms(200);
    TEST_ASSERT_EQUAL(STEPPER_CYCLE_NONE, stepper_cycle());
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_home(1u << AXIS_Z), err_message());
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(5));
    TEST_ASSERT_EQUAL_STRING("Homing Z failed: no answer from the driver", err_message());
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_it_is_called_around_each_approach);
    RUN_TEST(test_each_group_has_its_own_calls);
    RUN_TEST(test_a_refusal_changes_nothing);
    RUN_TEST(test_each_call_may_fail);
    RUN_TEST(test_disarming_may_fail_behind_the_end);
    RUN_TEST(test_stops_while_it_is_busy);
    RUN_TEST(test_stops_while_it_is_armed);
    RUN_TEST(test_a_new_cycle_waits_for_the_end_of_the_last);
    RUN_TEST(test_what_is_left_may_fail_in_a_new_cycle);
    return UNITY_END();
}
