// Spindle and coolant at their places in the motion, to the tick.
#include <unity.h>

#include "bench.h"
#include "hal/hal_io.h"
#include "hal/slices.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_pwm.h"
#include "stepper/stepper_safety.h"

#define TICK_NS 10000u
#define DIR_GPIO 16u
#define FLOOD_GPIO 17u
#define MIST_GPIO 18u
#define SLICE HAL_PWM_SLICE(BENCH_SPINDLE_GPIO)
#define COUNTS 62500u // of a period at 1 kHz: 125 MHz / 2 / 62500

void setUp(void) {}
void tearDown(void) {
    if (stepper_active() >= 0) { // the test has failed
        stepper_close();
    }
}

static const stepper_spindle_t pwm_spindle = {
    .gpio = BENCH_SPINDLE_GPIO,
    .dir_gpio = DIR_GPIO,
    .max_rpm = 10000,
    .min_rpm = 1000,
    .pwm_hz = 1000,
};

static void start(const stepper_spindle_t *spindle) {
    bench_start();
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_spindle(spindle), err_message());
}

static void switch_spindle(stepper_turn_t turn, double rpm) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_spindle_switch(turn, rpm), err_message());
}

static unsigned level(void) {
    return host_pwm_settings(SLICE)->level[HAL_PWM_CHANNEL(BENCH_SPINDLE_GPIO)];
}

static bool is_high(unsigned gpio) {
    return (hal_pins_read() & pins_mask(gpio)) != 0;
}

static void move_at(double x, double feed, double rpm) {
    while (stepper_blocks_free() == 0) {
        bench_wait_us(500);
    }
    stepper_move_t move = {
        .target = {x},
        .feed = feed,
        .sets_spindle = true,
        .spindle_rpm = rpm,
    };
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_move(&move), err_message());
}

static stepper_outputs_t outputs_now(void) {
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    return outputs;
}

// ---- Speed and duty -----------------------------------------------------------------------------

static void test_speed_is_duty(void) {
    static const struct {
        double rpm;
        unsigned level;
    } speeds[] = {{5000, COUNTS / 2},  {10000, COUNTS}, {20000, COUNTS},   {1, COUNTS / 10},
                  {1000, COUNTS / 10}, {0, 0},          {2500, COUNTS / 4}};
    start(&pwm_spindle);
    TEST_ASSERT_EQUAL_UINT(COUNTS - 1, host_pwm_settings(SLICE)->top);
    TEST_ASSERT_FALSE(stepper_spindle_limited());
    for (size_t i = 0; i < COUNT_OF_ARRAY(speeds); i++) {
        switch_spindle(STEPPER_SPINDLE_CW, speeds[i].rpm);
        bench_finish(1);
        TEST_ASSERT_EQUAL_UINT(speeds[i].level, level());
        double rpm = speeds[i].level * 10000.0 / COUNTS;
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, rpm, outputs_now().rpm);
        TEST_ASSERT_EQUAL(speeds[i].level > 0, outputs_now().spindle_on);
    }
    TEST_ASSERT_TRUE(stepper_spindle_limited());
    TEST_ASSERT_FALSE(stepper_spindle_limited());
    switch_spindle(STEPPER_SPINDLE_CW, 30000);
    TEST_ASSERT_FALSE(stepper_spindle_limited()); // said once
    switch_spindle(STEPPER_SPINDLE_OFF, 5000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_UINT(0, level());
    bench_end();
}

// How long the output is high in a second of virtual time, in us.
static unsigned high_us(void) {
    unsigned high = 0;
    for (unsigned us = 0; us < 10000; us += 10) {
        bench_wait_us(10);
        high += is_high(BENCH_SPINDLE_GPIO) ? 10 : 0;
    }
    return high;
}

static void test_pulses_at_the_pin(void) {
    stepper_spindle_t spindle = pwm_spindle;
    for (unsigned invert = 0; invert < 2; invert++) {
        spindle.invert = invert != 0;
        start(&spindle);
        TEST_ASSERT_EQUAL_UINT(invert ? 10000 : 0, high_us());
        switch_spindle(STEPPER_SPINDLE_CW, 2000);
        bench_wait_us(1000);
        TEST_ASSERT_UINT_WITHIN(100, invert ? 8000 : 2000, high_us());
        switch_spindle(STEPPER_SPINDLE_CW, 10000);
        bench_wait_us(1000);
        TEST_ASSERT_EQUAL_UINT(invert ? 0 : 10000, high_us());
        switch_spindle(STEPPER_SPINDLE_OFF, 0);
        bench_wait_us(1000);
        TEST_ASSERT_EQUAL_UINT(invert ? 10000 : 0, high_us());
        bench_end();
    }
}

// ---- In the queue -------------------------------------------------------------------------------

// Time from the spindle's start to the next step of X, in ticks.
static uint64_t start_to_step_ticks(const stepper_spindle_t *spindle, stepper_turn_t before,
                                    double rpm_before) {
    start(spindle);
    if (before != STEPPER_SPINDLE_OFF) {
        switch_spindle(before, rpm_before);
        bench_finish(10);
    }
    bench_move(1, 0, 0, 0, 600);
    switch_spindle(STEPPER_SPINDLE_CCW, 5000);
    bench_move(2, 0, 0, 0, 600);
    uint64_t switched_ns = 0;
    while (bench.motors[AXIS_X].position_steps < 81) {
        bench_wait_us(10);
        bool on = spindle->max_rpm > 0 ? level() == COUNTS / 2 : is_high(BENCH_SPINDLE_GPIO);
        if (switched_ns == 0 && on && is_high(DIR_GPIO)) {
            TEST_ASSERT_EQUAL_INT64(80, bench.motors[AXIS_X].position_steps);
            switched_ns = host_clock_now_ns();
        }
    }
    uint64_t ticks = (host_clock_now_ns() - switched_ns) / TICK_NS;
    bench_finish(5);
    bench_end();
    return ticks;
}

static void test_spin_up_takes_its_time_to_the_tick(void) {
    stepper_spindle_t spindle = pwm_spindle;
    uint64_t without = start_to_step_ticks(&spindle, STEPPER_SPINDLE_OFF, 0);
    spindle.spinup_ms = 345;
    TEST_ASSERT_EQUAL_UINT64(without + 34500,
                             start_to_step_ticks(&spindle, STEPPER_SPINDLE_OFF, 0));
    TEST_ASSERT_EQUAL_UINT64(without + 34500, // a reversal
                             start_to_step_ticks(&spindle, STEPPER_SPINDLE_CW, 5000));
    TEST_ASSERT_EQUAL_UINT64(without + 34500, // M3 S0 before: it stood
                             start_to_step_ticks(&spindle, STEPPER_SPINDLE_CCW, 0));
    spindle.max_rpm = spindle.min_rpm = 0; // on and off
    TEST_ASSERT_EQUAL_UINT64(without + 34500,
                             start_to_step_ticks(&spindle, STEPPER_SPINDLE_OFF, 0));
}

static void test_no_spin_up_while_it_turns(void) {
    stepper_spindle_t spindle = pwm_spindle;
    spindle.spinup_ms = 1000;
    start(&spindle);
    switch_spindle(STEPPER_SPINDLE_CW, 2000);
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 1.0, bench_finish(2));
    switch_spindle(STEPPER_SPINDLE_CW, 9000);
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 0.0, bench_finish(2));
    switch_spindle(STEPPER_SPINDLE_OFF, 0);
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 0.0, bench_finish(2));
    bench_end();
}

static void test_coolant_keeps_its_place(void) {
    for (unsigned invert = 0; invert < 2; invert++) {
        bool on = !invert;
        bench_start();
        stepper_coolant_t coolant = {FLOOD_GPIO, MIST_GPIO, invert != 0};
        TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant(&coolant));
        bench_move(1, 0, 0, 0, 600);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant_switch(true, false));
        bench_move(2, 0, 0, 0, 600);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant_switch(true, true));
        bench_move(3, 0, 0, 0, 600);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant_switch(false, false));
        while (stepper_active() > 0) {
            bench_wait_us(10);
            int64_t x = bench.motors[AXIS_X].position_steps;
            if (x % 80 != 0) {
                TEST_ASSERT_EQUAL(x > 80 ? on : !on, is_high(FLOOD_GPIO));
                TEST_ASSERT_EQUAL(x > 160 ? on : !on, is_high(MIST_GPIO));
            }
        }
        TEST_ASSERT_TRUE(is_high(FLOOD_GPIO) != on && is_high(MIST_GPIO) != on);
        bench_end();
    }
}

// ---- Speed in motion ----------------------------------------------------------------------------

// The middle between the last step that was made by then and the next: where the path was at the
// whole number of steps.
static void check_level_changes(unsigned before, unsigned after, int64_t boundary_steps) {
    uint64_t last_ns = 0;
    uint64_t changed_ns = 0;
    uint64_t step_ns = 0; // the one that led to the boundary
    while (bench.motors[AXIS_X].position_steps <= boundary_steps) {
        bench_wait_us(10);
        uint64_t now_ns = bench.motors[AXIS_X].last_step_ns;
        step_ns = bench.motors[AXIS_X].position_steps == boundary_steps ? now_ns : step_ns;
        last_ns = now_ns;
        if (changed_ns == 0 && level() != before) {
            TEST_ASSERT_EQUAL_UINT(after, level());
            changed_ns = host_clock_now_ns();
        }
    }
    uint64_t middle_ns = (step_ns + last_ns) / 2;
    TEST_ASSERT_UINT64_WITHIN(2 * TICK_NS, middle_ns, changed_ns);
}

static void check_speed_in_motion(bool scurve) {
    start(&pwm_spindle);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
    switch_spindle(STEPPER_SPINDLE_CW, 1000);
    bench_finish(1);
    bench.min_step_gap_ns = UINT64_MAX;
    move_at(20, 3000, 2000);
    move_at(40, 3000, 6000);
    move_at(41.0125, 3000, 3000);
    move_at(60, 3000, 0);
    bench_wait_us(1000);
    TEST_ASSERT_EQUAL_UINT(COUNTS / 5, level());
    check_level_changes(COUNTS / 5, COUNTS / 5 * 3, 1600);
    uint64_t before_ns = bench.motors[AXIS_X].last_step_ns;
    check_level_changes(COUNTS / 5 * 3, COUNTS / 10 * 3, 3200);
    // No slower anywhere between: 20 mm at 50 mm/s.
    uint64_t took_ns = bench.motors[AXIS_X].last_step_ns - before_ns;
    TEST_ASSERT_UINT64_WITHIN(TICK_NS, 400000000, took_ns);
    check_level_changes(COUNTS / 10 * 3, 0, 3281);
    bench_finish(2);
    TEST_ASSERT_EQUAL_UINT(0, level());
    TEST_ASSERT_EQUAL(STEPPER_SPINDLE_CW, outputs_now().turn);
    bench_check_positions();
    bench_end();
}

static void test_speed_in_motion_trapezoid(void) {
    check_speed_in_motion(false);
}

static void test_speed_in_motion_scurve(void) {
    check_speed_in_motion(true);
}

// An engraving: each tenth of a millimetre has another power. Returns how long it takes.
static double engrave(bool powers) {
    static const double steps_rpm[] = {9000, 0, 1500, 1500, 8000, 3000, 0, 10000};
    unsigned changes = 0;
    start(&pwm_spindle);
    switch_spindle(STEPPER_SPINDLE_CW, 0);
    bench_finish(1);
    unsigned last = level();
    unsigned expected = 0;
    uint64_t begin_us = hal_time_us();
    for (unsigned n = 1; n <= 600; n++) {
        double rpm = steps_rpm[n % COUNT_OF_ARRAY(steps_rpm)];
        double rpm_before = n > 1 ? steps_rpm[(n - 1) % COUNT_OF_ARRAY(steps_rpm)] : 0;
        expected += rpm != rpm_before;
        while (stepper_blocks_free() == 0) {
            bench_wait_us(10);
            changes += level() != last;
            last = level();
        }
        if (powers) {
            move_at(0.1 * n, 3000, rpm);
        } else {
            bench_move(0.1 * n, 0, 0, 0, 3000);
        }
    }
    while (stepper_active() > 0) {
        bench_wait_us(10);
        changes += level() != last;
        last = level();
    }
    double took_s = (double)(hal_time_us() - begin_us) * 1e-6;
    TEST_ASSERT_EQUAL_UINT(powers ? expected : 0, changes);
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(4800, stepper_position_steps(AXIS_X));
    bench_end();
    return took_s;
}

static void test_engraving_is_no_slower_for_its_powers(void) {
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, engrave(false), engrave(true));
}

static void test_speed_of_a_move_too_short_to_be_queued(void) {
    start(&pwm_spindle);
    switch_spindle(STEPPER_SPINDLE_CW, 2000);
    move_at(1, 600, 2000);
    move_at(1.001, 600, 4000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_UINT(COUNTS / 5 * 2, level());
    uint32_t free = stepper_blocks_free();
    move_at(1.001, 600, 4000);
    TEST_ASSERT_EQUAL_UINT32(free, stepper_blocks_free());
    bench_end();
}

static void test_speed_counts_only_while_it_is_on(void) {
    start(&pwm_spindle);
    move_at(1, 600, 5000);
    bench_finish(1);
    TEST_ASSERT_EQUAL_UINT(0, level());
    TEST_ASSERT_FALSE(outputs_now().spindle_on);
    bench_end();
    stepper_spindle_t relay = {.gpio = BENCH_SPINDLE_GPIO, .dir_gpio = PINS_NONE};
    start(&relay);
    switch_spindle(STEPPER_SPINDLE_CW, 0); // a speed of 0 counts for nothing without PWM
    move_at(1, 600, 5000);
    bench_finish(1);
    TEST_ASSERT_TRUE(is_high(BENCH_SPINDLE_GPIO));
    TEST_ASSERT_FALSE(stepper_spindle_limited());
    bench_end();
}

// ---- Stops --------------------------------------------------------------------------------------

static void check_all_off(void) {
    TEST_ASSERT_EQUAL_UINT(0, level());
    TEST_ASSERT_FALSE(is_high(BENCH_SPINDLE_GPIO));
    TEST_ASSERT_FALSE(is_high(FLOOD_GPIO) || is_high(MIST_GPIO));
    TEST_ASSERT_EQUAL(STEPPER_SPINDLE_OFF, outputs_now().turn);
}

static void check_emergency_stop(bool by_input) {
    for (unsigned us = 1000; us < 900000; us += 37130) { // spin-up, motion, coolant, motion
        stepper_spindle_t spindle = pwm_spindle;
        spindle.spinup_ms = 300;
        start(&spindle);
        stepper_coolant_t coolant = {FLOOD_GPIO, MIST_GPIO, false};
        TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant(&coolant));
        switch_spindle(STEPPER_SPINDLE_CW, 10000);
        bench_move(20, 0, 0, 0, 6000);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant_switch(true, true));
        bench_move(40, 0, 0, 0, 6000);
        bench_wait_us(us);
        TEST_ASSERT_EQUAL_UINT(COUNTS, level());
        if (by_input) {
            host_pads_drive(BENCH_ESTOP_GPIO, false);
            bench_wait_us(20);
        } else {
            TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
        }
        check_all_off();
        host_pads_drive(BENCH_ESTOP_GPIO, true);
        bench_wait_us(2000);
        check_all_off();
        TEST_ASSERT_EQUAL_UINT32(STEPPER_BLOCKS_DEFAULT, stepper_blocks_free());
        bench_check_positions();
        // It can be had again, with its spin-up.
        TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
        TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
        switch_spindle(STEPPER_SPINDLE_CW, 5000);
        TEST_ASSERT_DOUBLE_WITHIN(0.003, 0.3, bench_finish(1));
        TEST_ASSERT_UINT_WITHIN(100, 5000, high_us());
        bench_end();
    }
}

static void test_emergency_stop_turns_all_off_at_once(void) {
    check_emergency_stop(false);
}

static void test_emergency_input_turns_all_off_at_once(void) {
    check_emergency_stop(true);
}

// The clock of the spin-up stands in a feed hold.
static void test_hold_in_the_spin_up(void) {
    stepper_spindle_t spindle = pwm_spindle;
    spindle.spinup_ms = 500;
    start(&spindle);
    switch_spindle(STEPPER_SPINDLE_CW, 2000);
    bench_wait_us(200000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
    bench_wait_us(1000000);
    TEST_ASSERT_EQUAL_INT(1, stepper_active());
    TEST_ASSERT_EQUAL_UINT(COUNTS / 5, level());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 0.3, bench_finish(1));
    bench_end();
}

static void test_controlled_stop_and_hold_leave_the_spindle(void) {
    start(&pwm_spindle);
    switch_spindle(STEPPER_SPINDLE_CW, 2000);
    move_at(20, 3000, 4000);
    move_at(40, 3000, 8000);
    bench_wait_us(200000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
    bench_wait_us(300000);
    TEST_ASSERT_EQUAL_UINT(COUNTS / 5 * 2, level());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
    bench_wait_us(50000);
    stepper_stop();
    bench_finish(1);
    TEST_ASSERT_EQUAL_UINT(COUNTS / 5 * 2, level());
    // What is queued next has the speed that it has now, not what was dropped.
    double target[AXIS_COUNT];
    stepper_target(target);
    bench_move(0, 0, 0, 0, 3000);
    bench_finish(2);
    TEST_ASSERT_EQUAL_UINT(COUNTS / 5 * 2, level());
    switch_spindle(STEPPER_SPINDLE_OFF, 0);
    bench_wait_us(1000);
    TEST_ASSERT_EQUAL_UINT(0, level());
    bench_end();
    TEST_ASSERT_FALSE(is_high(BENCH_SPINDLE_GPIO));
}

// ---- Setting up ---------------------------------------------------------------------------------

static void check_refused(err_t expected, const stepper_spindle_t *spindle, const char *message) {
    stepper_outputs_t before = outputs_now();
    TEST_ASSERT_EQUAL(expected, stepper_spindle(spindle));
    TEST_ASSERT_EQUAL_STRING(message, err_message());
    stepper_outputs_t after = outputs_now();
    TEST_ASSERT_EQUAL_UINT8(before.spindle.gpio, after.spindle.gpio);
    TEST_ASSERT_EQUAL_UINT8(before.spindle.dir_gpio, after.spindle.dir_gpio);
    TEST_ASSERT_NULL(pins_owner(20));
    TEST_ASSERT_EQUAL_STRING("STEPPER spindle", pins_owner(BENCH_SPINDLE_GPIO));
    TEST_ASSERT_EQUAL_STRING("STEPPER spindle", slices_owner(SLICE));
}

static void test_refused_settings_change_nothing(void) {
    static const char somebody[] = "somebody";
    start(&pwm_spindle);
    stepper_spindle_t wrong = pwm_spindle;
    wrong.gpio = 20;
    wrong.dir_gpio = 3;
    check_refused(ERR_PIN_IN_USE, &wrong, "Pin GP3 (pin 5) is in use by STEPPER X dir");
    wrong.dir_gpio = 20;
    check_refused(ERR_PIN_TWICE, &wrong, "Pin GP20 (pin 26) is named twice");
    wrong.dir_gpio = DIR_GPIO;
    TEST_ASSERT_EQUAL(ERR_OK, slices_claim(HAL_PWM_SLICE(20), somebody));
    check_refused(ERR_PIN_OTHER_PWM, &wrong, "PWM slice 2 is in use by somebody");
    slices_disclaim(HAL_PWM_SLICE(20));
    wrong.pwm_hz = 1e8;
    check_refused(ERR_PWM_FREQUENCY, &wrong,
                  "Frequency is out of reach (valid is 7.5 to 31250000 Hz)");
    wrong.min_rpm = 10001;
    check_refused(ERR_SPINDLE_RANGE, &wrong, "Spindle min_rpm must not be above max_rpm");
    switch_spindle(STEPPER_SPINDLE_CW, 1000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(100));
    wrong = pwm_spindle;
    wrong.gpio = 20;
    check_refused(ERR_STEPPER_BUSY, &wrong,
                  "Not possible while motion is active or G-code is queued");
    bench_end();
    TEST_ASSERT_NULL(pins_owner(BENCH_SPINDLE_GPIO));
    TEST_ASSERT_NULL(pins_owner(DIR_GPIO));
    TEST_ASSERT_NULL(slices_owner(SLICE));
}

static void test_set_up_anew(void) {
    start(&pwm_spindle);
    switch_spindle(STEPPER_SPINDLE_CW, 5000);
    bench_finish(1);
    stepper_spindle_t other = pwm_spindle;
    other.gpio = DIR_GPIO; // pins swapped
    other.dir_gpio = BENCH_SPINDLE_GPIO;
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_spindle(&other), err_message());
    TEST_ASSERT_NULL(slices_owner(SLICE));
    TEST_ASSERT_FALSE(is_high(BENCH_SPINDLE_GPIO) || is_high(DIR_GPIO));
    TEST_ASSERT_FALSE(outputs_now().spindle_on);
    const stepper_spindle_t none = {.gpio = PINS_NONE, .dir_gpio = PINS_NONE};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_spindle(&none));
    TEST_ASSERT_NULL(pins_owner(BENCH_SPINDLE_GPIO));
    TEST_ASSERT_NULL(pins_owner(DIR_GPIO));
    TEST_ASSERT_NULL(slices_owner(HAL_PWM_SLICE(DIR_GPIO)));
    TEST_ASSERT_EQUAL(ERR_NO_SPINDLE_PIN, stepper_spindle_switch(STEPPER_SPINDLE_CW, 1));
    bench_end();
}

static void test_what_is_not_there_is_refused(void) {
    bench_start();
    TEST_ASSERT_EQUAL(ERR_NO_SPINDLE_DIR, stepper_spindle_switch(STEPPER_SPINDLE_CCW, 1000));
    TEST_ASSERT_EQUAL(ERR_NO_COOLANT_PIN, stepper_coolant_switch(true, false));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant_switch(false, false));
    stepper_coolant_t twice = {FLOOD_GPIO, FLOOD_GPIO, false};
    TEST_ASSERT_EQUAL(ERR_PIN_TWICE, stepper_coolant(&twice));
    stepper_coolant_t flood = {FLOOD_GPIO, PINS_NONE, false};
    bench_finish(1);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_coolant(&flood));
    TEST_ASSERT_EQUAL(ERR_NO_COOLANT_PIN, stepper_coolant_switch(true, true));
    bench_end();
    TEST_ASSERT_NULL(pins_owner(FLOOD_GPIO));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_speed_is_duty);
    RUN_TEST(test_pulses_at_the_pin);
    RUN_TEST(test_spin_up_takes_its_time_to_the_tick);
    RUN_TEST(test_no_spin_up_while_it_turns);
    RUN_TEST(test_coolant_keeps_its_place);
    RUN_TEST(test_speed_in_motion_trapezoid);
    RUN_TEST(test_speed_in_motion_scurve);
    RUN_TEST(test_engraving_is_no_slower_for_its_powers);
    RUN_TEST(test_speed_of_a_move_too_short_to_be_queued);
    RUN_TEST(test_speed_counts_only_while_it_is_on);
    RUN_TEST(test_emergency_stop_turns_all_off_at_once);
    RUN_TEST(test_emergency_input_turns_all_off_at_once);
    RUN_TEST(test_hold_in_the_spin_up);
    RUN_TEST(test_controlled_stop_and_hold_leave_the_spindle);
    RUN_TEST(test_refused_settings_change_nothing);
    RUN_TEST(test_set_up_anew);
    RUN_TEST(test_what_is_not_there_is_refused);
    return UNITY_END();
}
