// Controlled stop, emergency stop by command and by pin: when steps end, and that none is lost.
#include <math.h>
#include <stdlib.h>
#include <unity.h>

#include "bench.h"
#include "host_clock.h"
#include "host_pads.h"
#include "stepper/stepper_safety.h"

void setUp(void) {}
void tearDown(void) {}

static void press_estop(bool pressed) {
    host_pads_drive(BENCH_ESTOP_GPIO, !pressed);
}

static void test_stop_brakes_and_keeps_the_position(void) {
    srand(3);
    for (int round = 0; round < 40; round++) {
        bench_start();
        for (int i = 1; i <= 20; i++) {
            bench_move(10 * i, i % 2 * 5, 0, 0, 6000);
        }
        bench_wait_us((uint64_t)(rand() % 2000000));
        stepper_stop();
        const stepper_move_t move = {.target = {1, 2, 3, 4}, .feed = 6000, .rapid = false};
        TEST_ASSERT_EQUAL(ERR_STEPPER_STOPPING, stepper_move(&move));
        double time_s = bench_finish(1);
        TEST_ASSERT_TRUE(time_s < 0.23); // 100 mm/s at 500 mm/s^2, and what was computed ahead
        bench_check_positions();
        TEST_ASSERT_EQUAL_UINT32(STEPPER_BLOCKS_DEFAULT, stepper_blocks_free());
        // From here on as if nothing had been.
        bench_move(3, 4, 0, 0, 6000);
        bench_finish(10);
        bench_check_positions();
        TEST_ASSERT_EQUAL_INT32(240, stepper_position_steps(AXIS_X));
        TEST_ASSERT_EQUAL_INT32(320, stepper_position_steps(AXIS_Y));
        bench_end();
    }
}

static void test_stop_from_full_speed_takes_the_braking_distance(void) {
    bench_start();
    bench_move(500, 0, 0, 0, 6000);
    bench_wait_us(1000000);
    double from = stepper_position(AXIS_X);
    stepper_stop();
    bench_finish(1);
    // v^2 / 2a = 10 mm, and up to 17 ms at 100 mm/s that were computed ahead.
    double distance = stepper_position(AXIS_X) - from;
    TEST_ASSERT_TRUE(distance >= 10.0 && distance < 11.8);
    bench_end();
}

static void test_stop_in_a_dwell_and_at_rest(void) {
    bench_start();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(10000));
    bench_move(10, 0, 0, 0, 6000);
    bench_wait_us(100000);
    stepper_stop();
    TEST_ASSERT_TRUE(bench_finish(1) < 0.03);
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    stepper_stop();
    bench_move(1, 0, 0, 0, 6000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_INT32(80, stepper_position_steps(AXIS_X));
    bench_end();
}

static void test_stop_drops_what_waits_for_run(void) {
    bench_start();
    stepper_estop(); // disarmed
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    bench_move(10, 0, 0, 0, 6000);
    stepper_stop();
    TEST_ASSERT_EQUAL_UINT32(STEPPER_BLOCKS_DEFAULT, stepper_blocks_free());
    stepper_run(STEPPER_IDLE_HOLD);
    bench_move(0, 1, 0, 0, 6000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_INT32(0, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT32(80, stepper_position_steps(AXIS_Y));
    bench_end();
}

static void test_emergency_stop_ends_all_steps(void) {
    bench_start();
    bench_move(500, 0, 0, 0, 6000);
    bench_wait_us(1000000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    uint64_t stop_ns = host_clock_now_ns();
    bench_wait_us(100000);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(stop_ns, bench.last_step_ns);
    bench_check_positions();
    stepper_status_t status;
    stepper_status(&status);
    TEST_ASSERT_FALSE(status.armed);
    TEST_ASSERT_FALSE(status.position_known);
    TEST_ASSERT_EQUAL_UINT32(status.blocks, status.blocks_free);
    TEST_ASSERT_TRUE(hal_pins_read() & pins_mask(4)); // driver off
    bench_end();
}

// Segments that were dropped could have turned an axis, or be the first of a motion.
static void test_emergency_stop_at_any_tick_leaves_the_machine_in_order(void) {
    for (unsigned ticks = 0; ticks < 2400; ticks += ticks < 40 ? 1 : 37) {
        bench_start();
        bench_move(0.2, 0.1, 0, 0, 6000);
        bench_move(-0.2, 0.3, -0.01, 3, 6000);
        bench_move(0.2, 0.1, 0, 0, 6000);
        bench_wait_us(ticks * 10 + 5);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
        bench_check_positions();
        TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
        TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
        const int64_t x = bench.motors[AXIS_X].position_steps;
        const int64_t y = bench.motors[AXIS_Y].position_steps;
        bench_move(-1, 1, 0, 0, 6000);
        bench_finish(1);
        TEST_ASSERT_EQUAL_INT64(x - 80, bench.motors[AXIS_X].position_steps);
        TEST_ASSERT_EQUAL_INT64(y + 80, bench.motors[AXIS_Y].position_steps);
        bench_end();
    }
}

static void test_emergency_stop_at_rest_keeps_the_position(void) {
    bench_start();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_TRUE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    bench_end();
}

static void check_estop_pin(bool keeps_enabled) {
    bench_start_with(NULL, 32, keeps_enabled);
    press_estop(false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_spindle_switch(STEPPER_SPINDLE_CW, 0));
    bench_move(500, 0, 0, 0, 6000);
    bench_wait_us(1000005);
    press_estop(true);
    uint64_t pressed_ns = host_clock_now_ns();
    bench_wait_us(100000);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(pressed_ns, bench.last_step_ns); // no step after the next tick
    bench_check_positions();
    const stepper_move_t move = {.target = {1, 0, 0, 0}, .feed = 600, .rapid = false};
    TEST_ASSERT_EQUAL(ERR_ALARM, stepper_move(&move)); // before anybody asked
    TEST_ASSERT_EQUAL(STEPPER_EVENT_ESTOP, stepper_next_event());
    TEST_ASSERT_EQUAL(STEPPER_EVENT_NONE, stepper_next_event());
    TEST_ASSERT_EQUAL(STEPPER_STATUS_ESTOP, stepper_status_bits());
    TEST_ASSERT_EQUAL(!keeps_enabled, (hal_pins_read() & pins_mask(4)) != 0);
    TEST_ASSERT_FALSE(hal_pins_read() & pins_mask(BENCH_SPINDLE_GPIO));
    TEST_ASSERT_EQUAL(ERR_ESTOP_ACTIVE, stepper_run(STEPPER_IDLE_HOLD));

    press_estop(false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    int64_t before = bench.motors[AXIS_X].position_steps;
    bench_move(-1, 0, 0, 0, 6000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_INT64(before - 80, bench.motors[AXIS_X].position_steps);
    bench_end();
}

static void test_estop_pin_disables_the_drivers(void) {
    check_estop_pin(false);
}

static void test_estop_pin_keeps_the_drivers_if_wanted(void) {
    check_estop_pin(true);
}

static void test_estop_pin_is_watched_at_rest(void) {
    bench_start();
    press_estop(false);
    bench_wait_us(50000);
    press_estop(true);
    bench_wait_us(20);
    TEST_ASSERT_EQUAL(STEPPER_EVENT_ESTOP, stepper_next_event());
    TEST_ASSERT_TRUE(hal_pins_read() & pins_mask(4));
    press_estop(false);
    bench_end();
}

// The user may say where the machine stands before the language has told of the trip.
static void test_a_position_set_after_a_trip_stays_known(void) {
    bench_start();
    press_estop(false);
    bench_move(5, 0, 0, 0, 600);
    bench_wait_us(100000);
    press_estop(true);
    bench_wait_us(20);
    press_estop(false);
    TEST_ASSERT_EQUAL(0, stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    TEST_ASSERT_EQUAL(STEPPER_EVENT_ESTOP, stepper_next_event());
    TEST_ASSERT_EQUAL(STEPPER_STATUS_POSITION_KNOWN, stepper_status_bits());
    TEST_ASSERT_EQUAL(STEPPER_EVENT_NONE, stepper_next_event());
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_stop_brakes_and_keeps_the_position);
    RUN_TEST(test_stop_from_full_speed_takes_the_braking_distance);
    RUN_TEST(test_stop_in_a_dwell_and_at_rest);
    RUN_TEST(test_stop_drops_what_waits_for_run);
    RUN_TEST(test_emergency_stop_ends_all_steps);
    RUN_TEST(test_emergency_stop_at_any_tick_leaves_the_machine_in_order);
    RUN_TEST(test_emergency_stop_at_rest_keeps_the_position);
    RUN_TEST(test_estop_pin_disables_the_drivers);
    RUN_TEST(test_estop_pin_keeps_the_drivers_if_wanted);
    RUN_TEST(test_estop_pin_is_watched_at_rest);
    RUN_TEST(test_a_position_set_after_a_trip_stays_known);
    return UNITY_END();
}
