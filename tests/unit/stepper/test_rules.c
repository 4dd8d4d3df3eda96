// What is refused when, and that a refusal changes nothing.
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "stepper/stepper_safety.h"

void setUp(void) {}
void tearDown(void) {}

static const stepper_init_t plain = {0.05, 32, PINS_NONE, false};
static const stepper_axis_t x_axis = {2, 3, 4, false, 80, 6000, 500, 3};

static stepper_move_t to(double x, double y) {
    return (stepper_move_t){.target = {x, y, 0, 0}, .feed = 600};
}

static void check_refused(err_t expected, err_t actual, const char *message) {
    TEST_ASSERT_EQUAL(expected, actual);
    TEST_ASSERT_EQUAL_STRING(message, err_message());
}

static void test_nothing_works_before_init(void) {
    stepper_move_t move = to(1, 0);
    const char *message = "Stepper not initialized (use STEPPER INIT)";
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_axis(AXIS_X, &x_axis), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_limits(AXIS_X, 0, 1), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, bench_spindle(14, false), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_run(STEPPER_IDLE_HOLD), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_clear(), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_estop(), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_close(), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_set_home(), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_set_position(AXIS_X, 1), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_move(&move), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_dwell(1), message);
    check_refused(ERR_STEPPER_NOT_INITIALIZED, stepper_spindle_switch(STEPPER_SPINDLE_CW, 0),
                  message);
    stepper_stop();
    TEST_ASSERT_EQUAL_INT(-1, stepper_active());
    TEST_ASSERT_EQUAL_UINT32(0, stepper_blocks_free());
    TEST_ASSERT_EQUAL_UINT32(0, stepper_status_bits());
}

static void test_init_twice(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&plain));
    check_refused(ERR_STEPPER_ALREADY_INITIALIZED, stepper_init(&plain),
                  "Stepper already initialized (use STEPPER CLOSE to start anew)");
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&plain));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
}

static void test_pins_are_owned(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&plain));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &x_axis));
    stepper_axis_t y = x_axis;
    y.step_gpio = 16;
    check_refused(ERR_PIN_IN_USE, stepper_axis(AXIS_Y, &y),
                  "Pin GP3 (pin 5) is in use by STEPPER X dir");
    TEST_ASSERT_NULL(pins_owner(16)); // nothing kept of the refused axis
    TEST_ASSERT_FALSE(stepper_axis_configured(AXIS_Y));
    y.dir_gpio = 16;
    check_refused(ERR_PIN_IN_USE, stepper_axis(AXIS_Y, &y), "Pin GP16 (pin 21) is given twice");
    y.dir_gpio = 24;
    check_refused(ERR_PIN_INVALID, stepper_axis(AXIS_Y, &y), "Invalid pin GP24");
    check_refused(ERR_PIN_IN_USE, bench_spindle(4, false),
                  "Pin GP4 (pin 6) is in use by STEPPER X enable");
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
    TEST_ASSERT_NULL(pins_owner(2));
}

static void test_axis_can_be_configured_again(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&plain));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &x_axis));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    stepper_axis_t again = x_axis;
    again.step_gpio = 3; // step and direction exchanged
    again.dir_gpio = 2;
    again.max_velocity = 600;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &again));
    TEST_ASSERT_EQUAL_STRING("STEPPER X step", pins_owner(3));
    TEST_ASSERT_TRUE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    again.steps_per_unit = 160; // the motor stands where it stood, but where is that?
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &again));
    TEST_ASSERT_FALSE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    again.enable_gpio = 3;
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, stepper_axis(AXIS_X, &again));
    stepper_axis_t kept;
    TEST_ASSERT_TRUE(stepper_axis_config(AXIS_X, &kept));
    TEST_ASSERT_EQUAL_UINT8(4, kept.enable_gpio);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
}

static void test_moves_that_are_refused(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&plain));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &x_axis));
    stepper_move_t move = to(1, 0);
    check_refused(ERR_POSITION_UNKNOWN, stepper_move(&move),
                  "Machine position unknown - use STEPPER POSITION or G28 homing first");
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    move = to(1, 1);
    check_refused(ERR_AXIS_NOT_CONFIGURED, stepper_move(&move),
                  "Y axis not configured (use STEPPER AXIS)");
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_X, -10, 100));
    move = to(100.1, 0);
    check_refused(ERR_SOFT_LIMIT, stepper_move(&move), "X position exceeds soft limits");
    check_refused(ERR_LIMITS_ORDER, stepper_limits(AXIS_X, 5, 5), "Min must be less than max");
    check_refused(ERR_NO_SPINDLE_PIN, stepper_spindle_switch(STEPPER_SPINDLE_CW, 0),
                  "Spindle pin not configured (use STEPPER SPINDLE)");
    TEST_ASSERT_EQUAL_UINT32(32, stepper_blocks_free());
    move = to(100, 0);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_move(&move));
    double target[AXIS_COUNT];
    stepper_target(target);
    TEST_ASSERT_EQUAL_DOUBLE(100, target[AXIS_X]);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_clear());
    stepper_target(target);
    TEST_ASSERT_EQUAL_DOUBLE(0, target[AXIS_X]);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
}

static void test_too_far_for_the_step_counter(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&plain));
    stepper_axis_t fine = x_axis;
    fine.steps_per_unit = 100000;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(AXIS_X, &fine));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    const double far[] = {1e4 + 1, -1e300, 1e300};
    for (size_t i = 0; i < 3; i++) {
        stepper_move_t move = to(far[i], 0);
        TEST_ASSERT_EQUAL(ERR_AXIS_TOO_FAR, stepper_move(&move));
        TEST_ASSERT_EQUAL(ERR_AXIS_TOO_FAR, stepper_set_position(AXIS_X, far[i]));
    }
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
}

static void test_full_queue_loses_nothing(void) {
    bench_start_with(NULL, 4, false);
    int sent = 0;
    int refused = 0;
    while (sent < 50) {
        stepper_move_t move = to(sent + 1, 0);
        err_t err = stepper_move(&move);
        if (err == ERR_OK) {
            sent++;
        } else {
            check_refused(ERR_GCODE_BUFFER_FULL, err, "G-code buffer full");
            refused++;
            bench_wait_us(5000);
        }
    }
    TEST_ASSERT_TRUE(refused > 10);
    bench_finish(20);
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(4000, stepper_position_steps(AXIS_X));
    bench_end();
}

static void test_a_ring_of_one_slot_works(void) {
    bench_start_with(NULL, 1, false);
    bench_move(1, 1, 0, 0, 600);
    bench_move(2, 1, 0, 0, 600);
    bench_finish(10);
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(160, stepper_position_steps(AXIS_X));
    bench_end();
}

static void test_motion_forbids_configuration_but_not_questions(void) {
    bench_start();
    bench_move(10, 0, 0, 0, 600);
    bench_wait_us(100000);
    const char *message = "Not possible while motion is active or G-code is queued";
    check_refused(ERR_STEPPER_BUSY, stepper_axis(AXIS_X, &x_axis), message);
    check_refused(ERR_STEPPER_BUSY, bench_spindle(16, false), message);
    check_refused(ERR_STEPPER_BUSY, stepper_set_home(), message);
    check_refused(ERR_STEPPER_BUSY, stepper_set_position(AXIS_X, 3), message);
    check_refused(ERR_CLEAR_WHILE_ACTIVE, stepper_clear(),
                  "Cannot clear buffer while motion active");
    TEST_ASSERT_EQUAL_INT(1, stepper_active());
    bench_finish(10);
    bench_check_positions();
    TEST_ASSERT_EQUAL_INT32(800, stepper_position_steps(AXIS_X));
    bench_end();
}

static void test_set_position_moves_the_origin(void) {
    bench_start();
    bench_move(1, 0, 0, 0, 600);
    bench_finish(2);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_position(AXIS_X, 50));
    bench_move(49, 0, 0, 0, 600);
    bench_finish(2);
    TEST_ASSERT_EQUAL_INT64(0, bench.motors[AXIS_X].position_steps);
    TEST_ASSERT_EQUAL_DOUBLE(49, stepper_position(AXIS_X));
    bench_end();
}

// Settings that are allowed in motion do not touch the direction pins of what moves downwards.
static void test_settings_in_motion_do_not_disturb_it(void) {
    bench_start();
    bench_move(-10, -10, 0, 0, 3000);
    bench_wait_us(100000);
    TEST_ASSERT_EQUAL_INT(1, stepper_active());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limit_keep(true));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_filter(5, 2));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_junction(0.1));
    bench_finish(10);
    bench_check_positions();
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_nothing_works_before_init);
    RUN_TEST(test_init_twice);
    RUN_TEST(test_pins_are_owned);
    RUN_TEST(test_axis_can_be_configured_again);
    RUN_TEST(test_moves_that_are_refused);
    RUN_TEST(test_too_far_for_the_step_counter);
    RUN_TEST(test_full_queue_loses_nothing);
    RUN_TEST(test_a_ring_of_one_slot_works);
    RUN_TEST(test_motion_forbids_configuration_but_not_questions);
    RUN_TEST(test_set_position_moves_the_origin);
    RUN_TEST(test_settings_in_motion_do_not_disturb_it);
    return UNITY_END();
}
