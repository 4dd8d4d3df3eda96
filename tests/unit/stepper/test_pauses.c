// Pauses and line numbers: entries of the queue that hold the motion, and where each entry is from.
#include <stdlib.h>
#include <unity.h>

#include "bench.h"
#include "hal/hal_io.h"
#include "host_pwm.h"
#include "stepper/stepper_safety.h"

#define COUNTS 62500u // of a period at 1 kHz: 125 MHz / 2 / 62500

void setUp(void) {}
void tearDown(void) {
    if (stepper_active() >= 0) { // the test has failed
        stepper_close();
    }
}

static void start_with_spindle(void) {
    stepper_spindle_t spindle = {
        .gpio = BENCH_SPINDLE_GPIO,
        .dir_gpio = PINS_NONE,
        .max_rpm = 10000,
        .pwm_hz = 1000,
    };
    bench_start();
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_spindle(&spindle), err_message());
}

static unsigned level(void) {
    const hal_pwm_t *pwm = host_pwm_settings(HAL_PWM_SLICE(BENCH_SPINDLE_GPIO));
    return pwm->level[HAL_PWM_CHANNEL(BENCH_SPINDLE_GPIO)];
}

// ---- Pause --------------------------------------------------------------------------------------

static void test_pause_holds_in_place(void) {
    for (unsigned idle_off = 0; idle_off < 2; idle_off++) {
        start_with_spindle();
        TEST_ASSERT_EQUAL(ERR_OK, stepper_run((stepper_idle_t)idle_off));
        TEST_ASSERT_EQUAL(ERR_OK, stepper_spindle_switch(STEPPER_SPINDLE_CW, 2000));
        stepper_set_line(7);
        bench_move(10, 0, 0, 0, 6000);
        stepper_set_line(8);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_pause());
        stepper_set_line(9);
        bench_move(12, 0, 0, 0, 6000);
        bench_wait_us(100000);
        TEST_ASSERT_FALSE(stepper_paused());
        TEST_ASSERT_EQUAL(STEPPER_EVENT_NONE, stepper_next_event());
        TEST_ASSERT_EQUAL_UINT32(7, stepper_line());
        bench_wait_us(900000);
        TEST_ASSERT_EQUAL(STEPPER_EVENT_PAUSED, stepper_next_event());
        for (unsigned n = 0; n < 3; n++) {
            TEST_ASSERT_EQUAL(STEPPER_EVENT_NONE, stepper_next_event());
            stepper_status_t status;
            stepper_status(&status);
            TEST_ASSERT_TRUE(stepper_paused() && status.holding && status.moving);
            TEST_ASSERT_EQUAL_INT(1, stepper_active());
            TEST_ASSERT_EQUAL_UINT32(8, stepper_line());
            TEST_ASSERT_EQUAL_INT64(800, bench.motors[AXIS_X].position_steps);
            TEST_ASSERT_EQUAL_UINT(0, hal_pins_read() & pins_mask(bench_axes[AXIS_X].enable_gpio));
            TEST_ASSERT_EQUAL_UINT(COUNTS / 5, level());
            bench_wait_us(1000000);
        }
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
        TEST_ASSERT_FALSE(stepper_paused());
        TEST_ASSERT_EQUAL_UINT32(9, stepper_line());
        bench_finish(1);
        TEST_ASSERT_EQUAL_UINT32(0, stepper_line());
        TEST_ASSERT_EQUAL_INT64(960, bench.motors[AXIS_X].position_steps);
        bench_end();
    }
}

static void test_pause_as_the_last_entry_and_stops_in_it(void) {
    for (unsigned how = 0; how < 3; how++) {
        bench_start();
        bench_move(1, 0, 0, 0, 600);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_pause());
        bench_wait_us(500000);
        TEST_ASSERT_TRUE(stepper_paused());
        if (how == 0) {
            TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
        } else if (how == 1) {
            stepper_stop();
        } else {
            TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
            TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
            TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
        }
        bench_wait_us(5000);
        stepper_status_t status;
        stepper_status(&status);
        TEST_ASSERT_FALSE(stepper_paused() || status.holding);
        TEST_ASSERT_EQUAL_INT(0, stepper_active());
        bench_move(2, 0, 0, 0, 600);
        bench_finish(3);
        bench_end();
    }
}

static void test_hold_before_a_pause(void) {
    bench_start();
    bench_move(10, 0, 0, 0, 6000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_pause());
    bench_wait_us(50000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
    bench_wait_us(500000);
    TEST_ASSERT_FALSE(stepper_paused());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
    bench_wait_us(1000000);
    TEST_ASSERT_TRUE(stepper_paused()); // going on from the hold does not skip it
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 0.0, bench_finish(1));
    bench_end();
}

// ---- Line numbers -------------------------------------------------------------------------------

static void test_line_numbers_of_any_size(void) {
    static const uint32_t numbers[] = {1,      2,     0,          65534,      65535,
                                       65536,  70000, 4000000000, 4000000001, 3,
                                       131073, 0,     UINT32_MAX, 1,          65535};
    bench_start();
    for (size_t i = 0; i < COUNT_OF_ARRAY(numbers); i++) {
        stepper_set_line(numbers[i]);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(10));
        bench_wait_us(5000);
        TEST_ASSERT_EQUAL_UINT32(numbers[i], stepper_line());
        bench_finish(1);
        TEST_ASSERT_EQUAL_UINT32(0, stepper_line());
    }
    // Two spans of numbers wait at the same time, and many lines without an entry pass.
    stepper_set_line(100);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(10));
    for (uint32_t line = 101; line < 300000; line += 7) {
        stepper_set_line(line);
    }
    stepper_set_line(300000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(10));
    bench_wait_us(5000);
    TEST_ASSERT_EQUAL_UINT32(100, stepper_line());
    bench_wait_us(10000);
    TEST_ASSERT_EQUAL_UINT32(300000, stepper_line());
    stepper_set_line(0);
    bench_finish(1);
    bench_end();
}

static void test_lines_of_moves_and_blends(void) {
    bench_start();
    for (uint32_t line = 1; line <= 8; line++) {
        stepper_move_t move = {
            .target = {5.0 * line, line % 2 ? 5 : 0},
            .feed = 3000,
            .corner = STEPPER_CORNER_BLEND,
            .blend_mm = 0.5,
        };
        stepper_set_line(line);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_move(&move));
    }
    uint32_t last = 0;
    while (stepper_active() > 0) {
        uint32_t line = stepper_line();
        TEST_ASSERT_TRUE(line == last || line == last + 1 || line == 0);
        int64_t x = bench.motors[AXIS_X].position_steps;
        TEST_ASSERT_TRUE(line == 0 ||
                         llabs(x - 400 * (int64_t)line + 200) < 200 + 150); // blends reach back
        last = line != 0 ? line : last;
        bench_wait_us(1000);
    }
    TEST_ASSERT_EQUAL_UINT32(8, last);
    stepper_set_line(0);
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_pause_holds_in_place);
    RUN_TEST(test_pause_as_the_last_entry_and_stops_in_it);
    RUN_TEST(test_hold_before_a_pause);
    RUN_TEST(test_line_numbers_of_any_size);
    RUN_TEST(test_lines_of_moves_and_blends);
    return UNITY_END();
}
