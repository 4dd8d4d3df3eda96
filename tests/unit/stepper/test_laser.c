// The beam of a laser, tick by tick: what it burns, where it is off, and what puts it out. With a
// power in proportion to the speed each move burns power * way / feed, however it is ridden.
#include <math.h>
#include <unity.h>

#include "bench.h"
#include "hal/hal_io.h"
#include "homing_bench.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_pwm.h"
#include "stepper/stepper_homing.h"

#define SLICE HAL_PWM_SLICE(BENCH_SPINDLE_GPIO)
#define COUNTS 12500.0 // of a period at 10 kHz: 125 MHz / 12500
#define TICK_S 1e-5

void setUp(void) {}
void tearDown(void) {
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    stepper_close(); // what a failed test has left
}

static const stepper_spindle_t output = {
    .gpio = BENCH_SPINDLE_GPIO,
    .dir_gpio = PINS_NONE,
    .max_rpm = 1000,
    .pwm_hz = 10000,
    .spinup_ms = 500, // which a laser does not have
};

static void must(err_t err) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, err, err == ERR_OK ? "" : err_message());
}

static void start(stepper_turn_t turn, double power) {
    bench_start();
    must(stepper_spindle(&output));
    must(stepper_laser(true));
    must(stepper_spindle_switch(turn, power));
}

// Of the full power, as the tick has written it.
static double beam(void) {
    return host_pwm_settings(SLICE)->level[HAL_PWM_CHANNEL(BENCH_SPINDLE_GPIO)] / COUNTS;
}

static void cut(double x, double y, double feed, double power) {
    stepper_move_t move = {
        .target = {x, y},
        .feed = feed,
        .sets_spindle = true,
        .spindle_rpm = power,
    };
    while (stepper_blocks_free() == 0) {
        bench_wait_us(500);
    }
    must(stepper_move(&move));
}

static int64_t steps_of_x(void) {
    return bench.motors[AXIS_X].position_steps;
}

// What is burnt from now on until nothing moves: seconds at full power.
static double burnt(void) {
    double sum = 0.0;
    do {
        bench_wait_us(10);
        sum += beam() * TICK_S;
        TEST_ASSERT_TRUE(beam() <= 1.0);
    } while (stepper_active() > 0);
    TEST_ASSERT_TRUE(beam() == 0.0);
    return sum;
}

// ---- Power --------------------------------------------------------------------------------------

static void check_dose(bool scurve, stepper_corner_t corner) {
    static const struct {
        double x, y, feed, power;
    } cuts[] = {
        {10, 0, 3000, 500},   {10, 10, 3000, 500},  {10.3, 10, 3000, 900}, {10.3, 9.9, 1200, 900},
        {30, 30, 6000, 250},  {30, 60, 20000, 800}, // more than the axes can
        {30.05, 60, 3000, 0}, {30, 60, 3000, 1000},
    };
    double expected = 0.0;
    start(STEPPER_SPINDLE_CCW, 0);
    must(stepper_scurve(scurve));
    double x = 0.0, y = 0.0;
    for (size_t i = 0; i < COUNT_OF_ARRAY(cuts); i++) {
        stepper_move_t move = {
            .target = {cuts[i].x, cuts[i].y},
            .feed = cuts[i].feed,
            .corner = corner,
            .sets_spindle = true,
            .spindle_rpm = cuts[i].power,
        };
        must(stepper_move(&move));
        double way = sqrt((cuts[i].x - x) * (cuts[i].x - x) + (cuts[i].y - y) * (cuts[i].y - y));
        expected += way / (cuts[i].feed / 60.0) * cuts[i].power / 1000.0;
        x = cuts[i].x;
        y = cuts[i].y;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.002 * expected, expected, burnt());
    bench_check_positions();
    bench_end();
}

static void test_dose_does_not_depend_on_the_speed(void) {
    for (unsigned scurve = 0; scurve < 2; scurve++) {
        check_dose(scurve != 0, STEPPER_CORNER_CONTINUOUS);
        check_dose(scurve != 0, STEPPER_CORNER_STOP);
    }
}

static void test_dose_of_an_arc(void) {
    start(STEPPER_SPINDLE_CCW, 600);
    stepper_arc_t arc = {
        .move = {.target = {20, 0}, .feed = 4000},
        .plane = {AXIS_X, AXIS_Y},
        .centre = {10, 0},
        .turns = 1,
    };
    must(stepper_arc(&arc));
    double expected = 10 * 3.14159265 / (4000 / 60.0) * 0.6;
    TEST_ASSERT_DOUBLE_WITHIN(0.002 * expected, expected, burnt());
    bench_end();
}

// In each 4 ms the power is to its full value as the steps are to those at the feed.
static void test_power_follows_the_speed(void) {
    start(STEPPER_SPINDLE_CCW, 800);
    bench_move(20, 0, 0, 0, 4500);
    double greatest = 0.0;
    unsigned between = 0;
    while (stepper_active() > 0) {
        int64_t from = steps_of_x();
        double sum = 0.0;
        for (unsigned tick = 0; tick < 400; tick++) {
            bench_wait_us(10);
            sum += beam() / 400.0;
        }
        double speed = (double)(steps_of_x() - from) / 80.0 / 0.004;
        TEST_ASSERT_DOUBLE_WITHIN(0.8 * 4.0 / 75.0, 0.8 * speed / 75.0, sum); // a step is 3.1 mm/s
        greatest = fmax(greatest, sum);
        between += sum > 0.1 && sum < 0.7;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.0002, 0.8, greatest);
    TEST_ASSERT_TRUE(between > 30);
    bench_end();
}

// Up to a step in the middle of the acceleration.
static void test_dose_while_it_gets_faster(void) {
    for (unsigned scurve = 0; scurve < 2; scurve++) {
        start(STEPPER_SPINDLE_CCW, 800);
        must(stepper_scurve(scurve != 0));
        bench_move(20, 0, 0, 0, 6000);
        double sum = 0.0;
        while (steps_of_x() < 400) {
            bench_wait_us(10);
            sum += beam() * TICK_S;
        }
        double expected = 399.5 / 80.0 / 100.0 * 0.8;
        TEST_ASSERT_DOUBLE_WITHIN(0.002 * expected, expected, sum);
        bench_finish(2);
        bench_end();
    }
}

// At most what S says, also when somebody makes the machine faster.
static void test_overrides(void) {
    static const struct {
        int percent;
        double power;
    } cases[] = {{50, 0.3}, {100, 0.6}, {200, 0.6}};
    for (size_t i = 0; i < COUNT_OF_ARRAY(cases); i++) {
        start(STEPPER_SPINDLE_CCW, 600);
        must(stepper_override(cases[i].percent, 100));
        bench_move(20, 0, 0, 0, 2400);
        bench_wait_us(200000);
        TEST_ASSERT_DOUBLE_WITHIN(0.0005, cases[i].power, beam());
        must(stepper_override(100, 100));
        bench_wait_us(100000);
        TEST_ASSERT_DOUBLE_WITHIN(0.0005, 0.6, beam());
        bench_finish(10);
        bench_end();
    }
}

// Cuts and rapid moves in a row. Only the cuts burn, from their first to their last half step.
static void check_rapids(stepper_turn_t turn, stepper_corner_t corner) {
    start(turn, 500);
    for (unsigned n = 1; n <= 6; n++) {
        stepper_move_t move = {
            .target = {5.0 * n},
            .feed = 3000,
            .rapid = n % 2 == 0,
            .corner = corner,
            .blend_mm = 0.5,
        };
        must(stepper_move(&move));
    }
    double burning = 0.0;
    while (stepper_active() > 0) {
        int64_t before = steps_of_x();
        bench_wait_us(10);
        int64_t in_pair = before % 800;
        if (before == steps_of_x() && in_pair > 1 && in_pair < 399) {
            TEST_ASSERT_TRUE(turn == STEPPER_SPINDLE_CW ? beam() == 0.5 : beam() <= 0.5);
            TEST_ASSERT_TRUE(beam() > 0.0);
            burning += beam();
        } else if (in_pair > 401 && in_pair < 799) {
            TEST_ASSERT_TRUE(beam() == 0.0);
        }
    }
    TEST_ASSERT_TRUE(burning > 0.0 && beam() == 0.0);
    bench_end();
}

static void test_rapid_moves_are_dark(void) {
    for (stepper_turn_t turn = STEPPER_SPINDLE_CW; turn <= STEPPER_SPINDLE_CCW; turn++) {
        check_rapids(turn, STEPPER_CORNER_CONTINUOUS);
        check_rapids(turn, STEPPER_CORNER_STOP);
    }
}

// A rounded corner with a rapid move on one side is dark, others burn on.
static void test_blends(void) {
    for (unsigned rapid = 0; rapid < 3; rapid++) {
        start(STEPPER_SPINDLE_CCW, 1000);
        must(stepper_hold(true)); // as long as the first line has not begun
        for (unsigned n = 0; n < 2; n++) {
            stepper_move_t move = {
                .target = {10, 10.0 * n},
                .feed = 3000,
                .rapid = rapid == n + 1,
                .corner = STEPPER_CORNER_BLEND,
                .blend_mm = 1,
            };
            must(stepper_move(&move));
        }
        must(stepper_hold(false));
        double dose = burnt();
        // The corner is rounded off within 1 mm, which takes up to 2.8 mm of each side.
        double most = (rapid == 0 ? 20.001 : 8.5) / 50.0;
        double least = (rapid == 0 ? 18.0 : 7.0) / 50.0;
        TEST_ASSERT_TRUE(dose > least && dose < most);
        bench_end();
    }
}

// ---- No stops -----------------------------------------------------------------------------------

// Seconds for a line of pieces; `changes`: each with a mode or power of its own.
static double ride(bool changes) {
    start(STEPPER_SPINDLE_CW, 500);
    for (unsigned n = 1; n <= 400; n++) {
        if (changes && n % 3 == 0) {
            while (stepper_blocks_free() == 0) {
                bench_wait_us(500);
            }
            must(stepper_spindle_switch((stepper_turn_t)(n % 9 / 3), 100 + n));
        }
        cut(0.1 * n, 0, 3000, changes ? n : 500);
    }
    double took = bench_finish(10);
    TEST_ASSERT_EQUAL_INT32(3200, stepper_position_steps(AXIS_X));
    bench_check_positions();
    bench_end();
    return took;
}

static void test_modes_and_powers_change_without_a_stop(void) {
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, ride(false), ride(true));
    start(STEPPER_SPINDLE_CW, 500);
    uint32_t free = stepper_blocks_free();
    must(stepper_spindle_switch(STEPPER_SPINDLE_CCW, 100));
    cut(0.001, 0, 3000, 700); // too short to be queued
    TEST_ASSERT_EQUAL_UINT32(free, stepper_blocks_free());
    bench_move(10, 0, 0, 0, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(0.001, 0.7 * 10 / 50.0, burnt());
    bench_end();
}

// ---- Standstill ---------------------------------------------------------------------------------

static void test_hold_puts_it_out_and_resume_lights_it_again(void) {
    double whole = 40 / 50.0 * 0.5;
    for (unsigned us = 5000; us < 800000; us += 71000) {
        start(STEPPER_SPINDLE_CCW, 500);
        cut(20, 0, 3000, 500);
        cut(20, 20, 3000, 500);
        double sum = 0.0;
        for (unsigned t = 0; t < us + 400000; t += 10) {
            if (t == us) {
                must(stepper_hold(true));
            }
            bench_wait_us(10);
            sum += beam() * TICK_S;
        }
        TEST_ASSERT_TRUE(beam() == 0.0);
        must(stepper_hold(false));
        sum += burnt();
        TEST_ASSERT_DOUBLE_WITHIN(0.002 * whole, whole, sum);
        bench_end();
    }
}

// With constant power it is off within a tick or two of the last step before a standstill's place.
static void test_constant_power_is_off_at_standstill(void) {
    start(STEPPER_SPINDLE_CW, 500);
    cut(20, 0, 3000, 500);
    bench_wait_us(200000);
    TEST_ASSERT_TRUE(beam() == 0.5);
    must(stepper_hold(true));
    while (stepper_speed() > 0.0) {
        bench_wait_us(10);
        TEST_ASSERT_TRUE(beam() == 0.5);
    }
    bench_wait_us(2500); // as far as the governor is ahead
    int64_t stands = steps_of_x();
    TEST_ASSERT_TRUE(beam() == 0.0);
    bench_wait_us(1000000);
    TEST_ASSERT_TRUE(beam() == 0.0 && steps_of_x() == stands);
    must(stepper_hold(false));
    bench_wait_us(3000);
    TEST_ASSERT_TRUE(beam() == 0.5);
    while (stepper_active() > 0) {
        bench_wait_us(10);
    }
    TEST_ASSERT_TRUE(beam() == 0.0); // the end of the queue
    cut(25, 0, 3000, 500);           // and on again with what comes next
    bench_wait_us(20000);
    TEST_ASSERT_TRUE(beam() == 0.5);
    bench_finish(1);
    must(stepper_run(STEPPER_IDLE_DISABLE));
    cut(20, 0, 3000, 500);
    TEST_ASSERT_TRUE(burnt() > 0.05);
    bench_end();
}

// Dwell, pause and coolant between two cuts. `lit`: the dwell wants the beam, if it does not dim.
static void check_dwell(stepper_turn_t turn, bool lit) {
    start(turn, 400);
    must(stepper_coolant(&(stepper_coolant_t){17, PINS_NONE, false}));
    cut(1, 0, 1200, 400);
    must(lit ? stepper_laser_dwell(500) : stepper_dwell(500));
    must(stepper_coolant_switch(true, false));
    cut(2, 0, 1200, 400);
    bench_wait_us(300000);
    double expected = lit && turn == STEPPER_SPINDLE_CW ? 0.4 : 0.0;
    TEST_ASSERT_EQUAL_INT64(80, steps_of_x());
    TEST_ASSERT_TRUE(beam() == expected);
    must(stepper_hold(true));
    bench_wait_us(3000);
    TEST_ASSERT_TRUE(beam() == 0.0);
    bench_wait_us(300000);
    TEST_ASSERT_TRUE(beam() == 0.0);
    must(stepper_hold(false));
    bench_wait_us(3000);
    TEST_ASSERT_TRUE(beam() == expected);
    TEST_ASSERT_TRUE(burnt() > 0.01);
    must(stepper_pause());
    cut(3, 0, 1200, 400);
    bench_wait_us(300000);
    TEST_ASSERT_TRUE(stepper_paused() && beam() == 0.0);
    must(stepper_hold(false));
    TEST_ASSERT_TRUE(burnt() > 0.01);
    bench_end();
}

static void test_dwell_and_pause(void) {
    for (stepper_turn_t turn = STEPPER_SPINDLE_CW; turn <= STEPPER_SPINDLE_CCW; turn++) {
        check_dwell(turn, false);
        check_dwell(turn, true);
    }
}

// ---- What puts it out for good ------------------------------------------------------------------

// A cut without anything that lights the beam burns nothing; with it, it does.
static void check_out(double x) {
    bench_move(x, 0, 0, 0, 3000);
    TEST_ASSERT_TRUE(burnt() == 0.0);
    cut(x + 1, 0, 3000, 300); // a power is not enough
    TEST_ASSERT_TRUE(burnt() == 0.0);
    must(stepper_spindle_switch(STEPPER_SPINDLE_CCW, 300));
    bench_move(x, 0, 0, 0, 3000);
    TEST_ASSERT_DOUBLE_WITHIN(0.0002, 0.3 / 50.0, burnt());
}

static void test_stop_puts_it_out_before_the_machine_stands(void) {
    for (stepper_turn_t turn = STEPPER_SPINDLE_CW; turn <= STEPPER_SPINDLE_CCW; turn++) {
        start(turn, 500);
        for (unsigned n = 1; n <= 30; n++) { // it stops across blocks
            cut(n, 0, 3000, 500);
        }
        bench_wait_us(400000);
        TEST_ASSERT_DOUBLE_WITHIN(0.001, 0.5, beam());
        stepper_stop();
        bench_wait_us(2000);
        TEST_ASSERT_TRUE(stepper_speed() > 1000.0);
        while (stepper_active() > 0) {
            bench_wait_us(10);
            TEST_ASSERT_TRUE(beam() == 0.0);
        }
        check_out(15);
        bench_end();
    }
}

static void test_stop_in_a_dwell(void) {
    start(STEPPER_SPINDLE_CW, 500);
    must(stepper_laser_dwell(1000));
    bench_wait_us(10000);
    TEST_ASSERT_TRUE(beam() == 0.5);
    stepper_stop();
    bench_wait_us(3000);
    TEST_ASSERT_TRUE(beam() == 0.0);
    check_out(1);
    bench_end();
}

static void test_clear_and_off(void) {
    start(STEPPER_SPINDLE_CW, 500);
    must(stepper_clear());
    check_out(1);
    stepper_laser_off();
    check_out(3);
    must(stepper_spindle_switch(STEPPER_SPINDLE_OFF, 500));
    check_out(5);
    bench_end();
}

static void test_emergency_stop(void) {
    for (unsigned by_input = 0; by_input < 2; by_input++) {
        start(STEPPER_SPINDLE_CW, 1000);
        bench_move(20, 0, 0, 0, 3000);
        bench_wait_us(200000);
        TEST_ASSERT_TRUE(beam() == 1.0);
        if (by_input) {
            host_pads_drive(BENCH_ESTOP_GPIO, false);
            bench_wait_us(20);
        } else {
            must(stepper_estop());
        }
        TEST_ASSERT_TRUE(beam() == 0.0);
        TEST_ASSERT_TRUE((hal_pins_read() & pins_mask(BENCH_SPINDLE_GPIO)) == 0);
        host_pads_drive(BENCH_ESTOP_GPIO, true);
        must(stepper_set_home());
        must(stepper_run(STEPPER_IDLE_HOLD));
        check_out(1);
        // The pin shows the slice again.
        must(stepper_spindle_switch(STEPPER_SPINDLE_CW, 1000));
        bench_move(5, 0, 0, 0, 3000);
        bench_wait_us(50000);
        TEST_ASSERT_TRUE((hal_pins_read() & pins_mask(BENCH_SPINDLE_GPIO)) != 0);
        bench_finish(1);
        bench_end();
    }
}

// ---- Other motion -------------------------------------------------------------------------------

static void test_jogs_and_homing_are_dark(void) {
    homing_bench_start(true);
    must(stepper_spindle(&output));
    must(stepper_laser(true));
    must(stepper_spindle_switch(STEPPER_SPINDLE_CW, 500));
    homing_bench_put(AXIS_X, 2000);
    must(stepper_home(1u << AXIS_X));
    do {
        stepper_background();
        bench_wait_us(100);
        TEST_ASSERT_TRUE(beam() == 0.0);
    } while (stepper_cycle() != STEPPER_CYCLE_NONE);
    must(stepper_cycle_result());
    must(stepper_run(STEPPER_IDLE_HOLD));
    for (unsigned n = 0; n < 60; n++) { // the jog begins while the cut still burns
        cut(0.4 + 0.0125 * n, 0, 3000, 500);
        while (stepper_jog(AXIS_X, 1, 3000) != ERR_OK) {
            bench_wait_us(10);
        }
        bench_wait_us(3000);
        while (stepper_active() > 0) {
            bench_wait_us(10);
            TEST_ASSERT_TRUE(beam() == 0.0);
        }
    }
    bench_move(0, 0, 0, 0, 3000); // neither has put it out
    bench_wait_us(20000);
    TEST_ASSERT_TRUE(beam() == 0.5);
    bench_finish(2);
    bench_end();
}

// ---- Setting up ---------------------------------------------------------------------------------

static void test_what_is_refused(void) {
    bench_start();
    TEST_ASSERT_EQUAL(ERR_LASER_PWM, stepper_laser(true));
    must(stepper_laser(false));
    must(stepper_spindle(&output));
    TEST_ASSERT_EQUAL(ERR_NO_SPINDLE_DIR, stepper_spindle_check(STEPPER_SPINDLE_CCW));
    must(stepper_laser(true));
    must(stepper_spindle_check(STEPPER_SPINDLE_CCW));
    stepper_spindle_t relay = output;
    relay.max_rpm = 0;
    TEST_ASSERT_EQUAL(ERR_LASER_PWM, stepper_spindle(&relay));
    must(stepper_spindle(&output)); // which stays a laser
    TEST_ASSERT_TRUE(stepper_is_laser());
    must(stepper_dwell(10));
    TEST_ASSERT_EQUAL(ERR_STEPPER_BUSY, stepper_laser(false));
    bench_finish(1);
    must(stepper_laser(false));
    TEST_ASSERT_EQUAL(ERR_NO_SPINDLE_DIR, stepper_spindle_check(STEPPER_SPINDLE_CCW));
    must(stepper_laser(true));
    must(stepper_spindle(&(stepper_spindle_t){.gpio = PINS_NONE, .dir_gpio = PINS_NONE}));
    TEST_ASSERT_FALSE(stepper_is_laser());
    must(stepper_spindle(&output));
    must(stepper_laser(true));
    bench_end();
    TEST_ASSERT_FALSE(stepper_is_laser());
    TEST_ASSERT_EQUAL(ERR_STEPPER_NOT_INITIALIZED, stepper_laser(true));
}

// A spindle that turns does not become a beam, nor a beam a spindle.
static void test_changing_over_switches_off(void) {
    bench_start();
    stepper_spindle_t spindle = output;
    spindle.spinup_ms = 0;
    must(stepper_spindle(&spindle));
    must(stepper_spindle_switch(STEPPER_SPINDLE_CW, 700));
    bench_finish(1);
    TEST_ASSERT_TRUE(beam() == 0.7);
    must(stepper_laser(true));
    TEST_ASSERT_TRUE(beam() == 0.0);
    check_out(1);
    must(stepper_laser(false));
    bench_move(3, 0, 0, 0, 3000);
    TEST_ASSERT_TRUE(burnt() == 0.0);
    must(stepper_spindle_switch(STEPPER_SPINDLE_CW, 700));
    bench_finish(1);
    TEST_ASSERT_TRUE(beam() == 0.7);
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_dose_does_not_depend_on_the_speed);
    RUN_TEST(test_dose_of_an_arc);
    RUN_TEST(test_power_follows_the_speed);
    RUN_TEST(test_dose_while_it_gets_faster);
    RUN_TEST(test_overrides);
    RUN_TEST(test_rapid_moves_are_dark);
    RUN_TEST(test_blends);
    RUN_TEST(test_modes_and_powers_change_without_a_stop);
    RUN_TEST(test_hold_puts_it_out_and_resume_lights_it_again);
    RUN_TEST(test_constant_power_is_off_at_standstill);
    RUN_TEST(test_dwell_and_pause);
    RUN_TEST(test_stop_puts_it_out_before_the_machine_stands);
    RUN_TEST(test_stop_in_a_dwell);
    RUN_TEST(test_clear_and_off);
    RUN_TEST(test_emergency_stop);
    RUN_TEST(test_jogs_and_homing_are_dark);
    RUN_TEST(test_what_is_refused);
    RUN_TEST(test_changing_over_switches_off);
    return UNITY_END();
}
