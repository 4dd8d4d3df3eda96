// Homing: to the step, from anywhere, in any order, and every way in which it can fail.
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "homing_bench.h"
#include "host_clock.h"
#include "host_pads.h"

#define PULL_OFF_X (3 * 80) // steps
#define PULL_OFF_Z (3 * 400)

void setUp(void) {}
void tearDown(void) {
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    stepper_close(); // what a failed test has left
}

static const stepper_home_t plain = {.latch = STEPPER_HOME_LATCH};

static void home(uint32_t axes, double limit_s) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_home(axes), err_message());
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(limit_s), err_message());
}

static bool is_known(void) {
    return (stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN) != 0;
}

static bool is_armed(void) {
    stepper_status_t status;
    stepper_status(&status);
    return status.armed;
}

static bool drivers_on(void) {
    return (hal_pins_read() & pins_mask(bench_axes[AXIS_X].enable_gpio)) == 0;
}

// X is at home and stands `pull_off` from the step at which its switch closed.
static void check_x_home(void) {
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_X].position_steps);
}

// ---- Where it ends ------------------------------------------------------------------------------

static void check_random_starts(bool scurve) {
    srand(11);
    for (int round = 0; round < 200; round++) {
        homing_bench_start(round % 3 != 0);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
        // Also on the switch, as deep as it gets when it brakes from the fast approach.
        int64_t from = rand() % 5 == 0 ? -(rand() % 250) : rand() % 16000;
        homing_bench_put(AXIS_X, from);
        home(1u << AXIS_X, 40);
        check_x_home();
        bench_end();
    }
}

static void test_200_random_starts_end_at_the_same_step(void) {
    check_random_starts(false);
}

static void test_200_random_starts_with_an_scurve(void) {
    check_random_starts(true);
}

static void test_the_maximum_and_a_home_position(void) {
    homing_bench_start(false);
    stepper_home_t wanted = plain;
    wanted.end = STEPPER_HOME_MAX;
    wanted.position_mm = 250.0;
    wanted.pull_off_mm = 1.5;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
    home(1u << AXIS_X, 40);
    TEST_ASSERT_EQUAL_INT32(20000, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT64(20000 - 120, bench.motors[AXIS_X].position_steps);
    home(1u << AXIS_Z, 40); // by itself: only its maximum has a switch
    TEST_ASSERT_EQUAL_INT64(-PULL_OFF_Z, bench.motors[AXIS_Z].position_steps);
    bench_end();
}

static void test_feeds_are_those_of_the_configuration_whatever_the_override(void) {
    for (int percent = 10; percent <= 200; percent += 95) {
        homing_bench_start(true);
        stepper_home_t wanted = plain;
        wanted.seek = 1200.0;
        wanted.latch = 120.0;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_override(percent, 100));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        homing_bench_reach(AXIS_X, "approaching the switch", 300000);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 1200.0, stepper_speed());
        TEST_ASSERT_EQUAL(ERR_OK, stepper_override(210 - percent, 100)); // nor what it becomes
        bench_wait_us(100000);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 1200.0, stepper_speed());
        homing_bench_reach(AXIS_X, "approaching slowly", 300000);
        TEST_ASSERT_DOUBLE_WITHIN(0.1, 120.0, stepper_speed());
        TEST_ASSERT_EQUAL(ERR_OK, homing_bench_finish(20));
        check_x_home();
        bench_move(20, 0, 0, 0, 1000); // it counts again
        bench_wait_us(400000);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 10.0 * (210 - percent), stepper_speed());
        bench_end();
    }
}

static void test_the_first_approach_is_exact_without_a_second(void) {
    srand(5);
    for (int round = 0; round < 40; round++) {
        homing_bench_start(false);
        stepper_home_t wanted = plain;
        wanted.latch = 0.0;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
        homing_bench_put(AXIS_X, 100 + rand() % 9000);
        home(1u << AXIS_X, 40);
        check_x_home();
        bench_end();
    }
}

// Contacts that bounce for as long as an axis takes to back off.
static void test_slow_contacts_on_a_short_way(void) {
    simulate_switch_t *x_min = &homing_switches[SWITCH_X_MIN];
    const uint32_t usual_us = x_min->bounce_us;
    stepper_home_t wanted = plain;
    wanted.pull_off_mm = 0.1;
    wanted.latch = 30.0;
    for (int round = 0; round < 30; round++) {
        homing_bench_start(false);
        x_min->bounce_us = 16000;
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
        homing_bench_put(AXIS_X, round % 2 == 0 ? 500 + 17 * round : -5 * round);
        home(1u << AXIS_X, 40);
        TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
        TEST_ASSERT_EQUAL_INT64(8, bench.motors[AXIS_X].position_steps);
        bench_end();
    }
    x_min->bounce_us = usual_us;
}

// ---- Order and groups ---------------------------------------------------------------------------

// The groups in which the axes are homed, as digits of a number: 4 for Z, 1 for X, 2 for Y.
static uint32_t homed_groups(void) {
    uint32_t groups = 0;
    uint32_t before = 0;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(0));
    while (stepper_cycle() != STEPPER_CYCLE_NONE) {
        uint32_t axes;
        const char *phase = stepper_homing_phase(&axes);
        if (axes != before && strcmp(phase, "waiting for the queue") != 0) {
            groups = groups * 10 + axes;
            before = axes;
        }
        bench_wait_us(250);
        stepper_background();
    }
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_cycle_result(), err_message());
    check_x_home();
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X, bench.motors[AXIS_Y].position_steps);
    TEST_ASSERT_EQUAL_INT64(-PULL_OFF_Z, bench.motors[AXIS_Z].position_steps);
    TEST_ASSERT_TRUE(is_known());
    return groups;
}

static void test_order_and_groups(void) {
    static const struct {
        uint8_t groups[STEPPER_HOME_AXES];
        uint32_t homed;
    } orders[] = {
        {{4, 1, 2}, 412}, {{4, 3, 0}, 43}, {{7, 0, 0}, 7}, {{2, 1, 0}, 214}, {{0, 0, 0}, 124},
    };
    homing_bench_start(false);
    TEST_ASSERT_EQUAL_UINT32(412, homed_groups()); // Z first, as it is safest
    bench_end();
    for (size_t i = 0; i < COUNT_OF_ARRAY(orders); i++) {
        homing_bench_start(false);
        homing_bench_put(AXIS_X, 700 + 1311 * (int64_t)i);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_order(orders[i].groups));
        TEST_ASSERT_EQUAL_UINT32(orders[i].homed, homed_groups());
        bench_end();
    }
    homing_bench_start(false);
    const uint8_t twice[] = {4, 3, 2};
    TEST_ASSERT_EQUAL(ERR_HOME_ORDER, stepper_home_order(twice));
    TEST_ASSERT_EQUAL_UINT32(412, homed_groups());
    bench_end();
}

// Both switches close within the way that braking takes, in all distances from each other.
static void test_two_axes_that_arrive_together_disturb_each_other_not(void) {
    const uint8_t order[] = {3, 0, 0};
    stepper_home_t wanted = plain;
    wanted.pull_off_mm = 0.5; // less than the way of braking
    for (int apart = -300; apart <= 300; apart += 13) {
        homing_bench_start(false);
        homing_bench_put(AXIS_X, 3000);
        homing_bench_put(AXIS_Y, 3000 + apart);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_order(order));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_Y, &wanted));
        home(3, 40);
        TEST_ASSERT_EQUAL_INT64(40, bench.motors[AXIS_X].position_steps);
        TEST_ASSERT_EQUAL_INT64(40, bench.motors[AXIS_Y].position_steps);
        TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_Y));
        bench_end();
    }
}

// ---- What is known ------------------------------------------------------------------------------

static void test_the_position_is_known_when_all_that_can_be_homed_is(void) {
    homing_bench_start(false);
    home(1u << AXIS_Z, 40);
    TEST_ASSERT_FALSE(is_known());
    home(1u << AXIS_X, 40);
    TEST_ASSERT_FALSE(is_known());
    home(1u << AXIS_Y, 40);
    TEST_ASSERT_TRUE(is_known());
    home(1u << AXIS_X, 40);
    TEST_ASSERT_TRUE(is_known());
    bench_move(10, 10, -1, 0, 6000);
    bench_finish(10);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    homing_bench_reach(AXIS_X, "approaching the switch", 50000);
    stepper_stop();
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, homing_bench_finish(2));
    TEST_ASSERT_FALSE(is_known());
    home(1u << AXIS_X, 40); // only X was lost
    TEST_ASSERT_TRUE(is_known());
    TEST_ASSERT_EQUAL_INT32(800, stepper_position_steps(AXIS_Y));
    bench_end();
}

static void test_a_lost_position_is_lost_for_all_axes(void) {
    homing_bench_start(false);
    home(0, 80);
    bench_move(50, 10, -1, 0, 6000);
    bench_wait_us(300000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_FALSE(is_known());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    home(1u << AXIS_X, 40);
    TEST_ASSERT_FALSE(is_known());
    home(6, 40);
    TEST_ASSERT_TRUE(is_known());
    bench_end();
}

// The switches of the axes that were homed trip again, however it ended.
static void test_switches_are_watched_behind_it(void) {
    for (unsigned how = 0; how < 3; how++) {
        homing_bench_start(true);
        stepper_home_t wanted = plain;
        wanted.max_travel_mm = how == 1 ? 20.0 : 100.0; // of the 50 mm to the switch
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_X, &wanted));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
        if (how == 2) {
            homing_bench_reach(AXIS_X, "approaching the switch", 200000);
            stepper_stop();
        }
        err_t ended = homing_bench_finish(20);
        TEST_ASSERT_EQUAL(how == 0 ? ERR_OK : ERR_HOMING_FAILED, ended);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
        bench_move(-60, 0, 0, 0, 6000);
        bench_wait_us(3000000);
        TEST_ASSERT_EQUAL(STEPPER_ALARM_LIMIT, stepper_alarm());
        TEST_ASSERT_EQUAL_INT64(0, bench.motors[AXIS_X].position_steps);
        bench_end();
    }
}

// ---- Before and behind it -----------------------------------------------------------------------

static void test_the_queue_is_executed_before(void) {
    homing_bench_start(true);
    bench_move(20, 0, 0, 0, 6000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(100));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    const stepper_move_t move = {.target = {1, 0, 0, 0}, .feed = 600};
    TEST_ASSERT_EQUAL(ERR_CYCLE_ACTIVE, stepper_move(&move));
    TEST_ASSERT_EQUAL_STRING("Homing is under way (STEPPER STOP or Ctrl-C ends it)", err_message());
    TEST_ASSERT_EQUAL(ERR_CYCLE_ACTIVE, stepper_home(0));
    TEST_ASSERT_EQUAL(ERR_CYCLE_ACTIVE, stepper_home_config(AXIS_X, &plain));
    uint32_t axes;
    TEST_ASSERT_EQUAL_STRING("waiting for the queue", stepper_homing_phase(&axes));
    homing_bench_reach(AXIS_X, "approaching the switch", 0);
    TEST_ASSERT_EQUAL_INT64(4000 + 1600, bench.motors[AXIS_X].position_steps);
    TEST_ASSERT_EQUAL(ERR_OK, homing_bench_finish(20));
    check_x_home();
    bench_move(1, 0, 0, 0, 600); // goes on from there
    bench_finish(2);
    TEST_ASSERT_EQUAL_INT64(PULL_OFF_X + 80, bench.motors[AXIS_X].position_steps);
    bench_end();
}

static void test_disarmed_it_turns_the_drivers_on_and_leaves_them_on(void) {
    homing_bench_start(false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_FALSE(is_armed());
    TEST_ASSERT_FALSE(drivers_on());
    home(1u << AXIS_X, 40);
    check_x_home();
    TEST_ASSERT_FALSE(is_armed());
    TEST_ASSERT_TRUE(drivers_on());
    bench_end();

    homing_bench_start(true);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    bench_move(1, 0, 0, 0, 600);
    TEST_ASSERT_EQUAL(ERR_NOT_ARMED, stepper_home(1u << AXIS_X)); // the move would be lost
    TEST_ASSERT_EQUAL(STEPPER_CYCLE_NONE, stepper_cycle());
    bench_end();
}

static void test_drivers_stay_on_between_its_moves(void) {
    homing_bench_start(true);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_DISABLE));
    bench_wait_us(10000);
    TEST_ASSERT_FALSE(drivers_on());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home(1u << AXIS_X));
    homing_bench_reach(AXIS_X, "approaching the switch", 0);
    while (stepper_cycle() != STEPPER_CYCLE_NONE) {
        TEST_ASSERT_TRUE(drivers_on());
        bench_wait_us(200);
        stepper_background();
    }
    bench_wait_us(10000);
    TEST_ASSERT_FALSE(drivers_on());
    check_x_home();
    bench_end();
}

static void test_what_is_refused(void) {
    homing_bench_start(false);
    stepper_home_t wanted = plain;
    wanted.end = STEPPER_HOME_MAX;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_home_config(AXIS_Y, &wanted));
    TEST_ASSERT_EQUAL(ERR_HOME_NO_SWITCH, stepper_home(1u << AXIS_Y));
    TEST_ASSERT_EQUAL_STRING("Y has no home switch (use STEPPER HWLIMITS)", err_message());
    stepper_hwlimits_t none;
    memset(&none, 0, sizeof none);
    memset(none.gpio, PINS_NONE, sizeof none.gpio);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&none));
    TEST_ASSERT_EQUAL(ERR_HOME_NO_SWITCH, stepper_home(0));
    TEST_ASSERT_EQUAL_STRING("No axis has a home switch (use STEPPER HWLIMITS)", err_message());
    bench_end();
    TEST_ASSERT_EQUAL(ERR_STEPPER_NOT_INITIALIZED, stepper_home(0));
    TEST_ASSERT_EQUAL(ERR_STEPPER_NOT_INITIALIZED, stepper_home_config(AXIS_X, &plain));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_200_random_starts_end_at_the_same_step);
    RUN_TEST(test_200_random_starts_with_an_scurve);
    RUN_TEST(test_the_maximum_and_a_home_position);
    RUN_TEST(test_feeds_are_those_of_the_configuration_whatever_the_override);
    RUN_TEST(test_the_first_approach_is_exact_without_a_second);
    RUN_TEST(test_slow_contacts_on_a_short_way);
    RUN_TEST(test_order_and_groups);
    RUN_TEST(test_two_axes_that_arrive_together_disturb_each_other_not);
    RUN_TEST(test_the_position_is_known_when_all_that_can_be_homed_is);
    RUN_TEST(test_a_lost_position_is_lost_for_all_axes);
    RUN_TEST(test_switches_are_watched_behind_it);
    RUN_TEST(test_the_queue_is_executed_before);
    RUN_TEST(test_disarmed_it_turns_the_drivers_on_and_leaves_them_on);
    RUN_TEST(test_drivers_stay_on_between_its_moves);
    RUN_TEST(test_what_is_refused);
    return UNITY_END();
}
