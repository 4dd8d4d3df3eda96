// Probing: to the step at any speed, what it refuses, how it fails.
#include <math.h>
#include <stdlib.h>
#include <unity.h>

#include "homing_bench.h"
#include "host_clock.h"
#include "host_pads.h"

void setUp(void) {}
void tearDown(void) {
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    stepper_close(); // what a failed test has left
}

static simulate_switch_t *const plate = &homing_switches[SWITCH_PROBE];

static stepper_move_t to(double x, double y, double feed) {
    return (stepper_move_t){.target = {x, y, 0, 0}, .feed = feed};
}

// Nothing but the plate is in the way; X is at 50 mm, 4000 steps from it.
static void begin(int64_t plate_steps) {
    homing_bench_start(true);
    plate->to_steps = plate_steps;
    homing_bench_put(AXIS_X, 4000);
    stepper_hwlimits_t none;
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        none.gpio[n] = PINS_NONE;
    }
    none.active_high = 0;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hwlimits(&none));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_position(AXIS_X, 50.0));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_position(AXIS_Y, 50.0));
    while (stepper_next_event() != STEPPER_EVENT_NONE) {
    }
}

static void probe(const stepper_move_t *move, bool away, bool must_change) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_probe(move, away, must_change), err_message());
}

static stepper_event_t last_event(void) {
    stepper_event_t last = STEPPER_EVENT_NONE;
    for (stepper_event_t event; (event = stepper_next_event()) != STEPPER_EVENT_NONE;) {
        last = event;
    }
    return last;
}

static void check_counts(void) {
    TEST_ASSERT_EQUAL_INT64(bench.motors[AXIS_X].position_steps, stepper_position_steps(AXIS_X));
    TEST_ASSERT_EQUAL_INT64(bench.motors[AXIS_Y].position_steps, stepper_position_steps(AXIS_Y));
}

// The plate at some step, the feed anything up to the axis's greatest; the tick that sees the
// contact is the next one after the step that makes it, so the place is that step.
static void check_many(bool scurve) {
    srand(7);
    for (int round = 0; round < 150; round++) {
        const double feed = pow(10.0, 1.0 + 2.8 * rand() / RAND_MAX);
        begin(feed < 300.0 ? 3990 - rand() % 200 : rand() % 3900); // no longer than a minute
        TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
        const stepper_move_t move = to(-10.0, 50.0 + 20.0 * (round % 3), feed);
        probe(&move, false, true);
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(200), err_message());
        double place[AXIS_COUNT];
        TEST_ASSERT_TRUE(stepper_probed(place));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, (double)plate->to_steps / 80.0, place[AXIS_X]);
        TEST_ASSERT_TRUE(stepper_probe_contact());
        TEST_ASSERT_EQUAL(STEPPER_EVENT_PROBED, last_event());
        check_counts();
        bench_end();
    }
}

static void test_the_place_is_exact_at_any_speed(void) {
    check_many(false);
}

static void test_the_place_is_exact_with_an_scurve(void) {
    check_many(true);
}

static void test_contact_can_be_lost(void) {
    for (unsigned round = 0; round < 20; round++) {
        begin(4100);
        const stepper_move_t move = to(80.0, 50.0, 600.0 + 250.0 * round);
        probe(&move, true, true);
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
        double place[AXIS_COUNT];
        TEST_ASSERT_TRUE(stepper_probed(place));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4101 / 80.0, place[AXIS_X]);
        TEST_ASSERT_FALSE(stepper_probe_contact());
        check_counts();
        bench_end();
    }
}

static void test_active_high(void) {
    begin(100);
    plate->pressed_level = true;
    TEST_ASSERT_EQUAL(ERR_OK, stepper_probe_pin(PROBE_GPIO, true));
    host_pads_drive(PROBE_GPIO, false);
    const stepper_move_t move = to(0.0, 50.0, 3000.0);
    probe(&move, false, true);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, homing_bench_finish(20), err_message());
    double place[AXIS_COUNT];
    TEST_ASSERT_TRUE(stepper_probed(place));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100 / 80.0, place[AXIS_X]);
    plate->pressed_level = false;
    bench_end();
}

// What is queued moves on behind it from where the machine stands.
static void test_the_queue_before_and_moves_behind(void) {
    begin(1000);
    bench_move(45, 45, 0, 0, 6000);
    stepper_move_t move = to(0.0, 45.0, 3000.0);
    probe(&move, false, true);
    const stepper_move_t other = to(1.0, 45.0, 3000.0);
    TEST_ASSERT_EQUAL(ERR_CYCLE_ACTIVE, stepper_move(&other));
    TEST_ASSERT_EQUAL_STRING("Probing is under way (STEPPER STOP or Ctrl-C ends it)",
                             err_message());
    TEST_ASSERT_EQUAL(ERR_OK, homing_bench_finish(20));
    double target[AXIS_COUNT];
    stepper_target(target);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, stepper_position(AXIS_X), target[AXIS_X]);
    TEST_ASSERT_EQUAL_INT32(3600, stepper_position_steps(AXIS_Y));
    bench_move(40, 40, 0, 0, 6000);
    bench_finish(10);
    TEST_ASSERT_EQUAL_INT32(3200, stepper_position_steps(AXIS_X));
    check_counts();
    bench_end();
}

// ---- Failures -----------------------------------------------------------------------------------

static void check_failure(const char *said) {
    TEST_ASSERT_EQUAL(ERR_PROBING_FAILED, homing_bench_finish(20));
    TEST_ASSERT_EQUAL_STRING(said, err_message());
    double place[AXIS_COUNT];
    TEST_ASSERT_FALSE(stepper_probed(place));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, stepper_position(AXIS_X), place[AXIS_X]);
    TEST_ASSERT_EQUAL(STEPPER_EVENT_PROBED, last_event());
    check_counts();
}

static void test_no_contact_before_the_target(void) {
    begin(0);
    const stepper_move_t move = to(20.0, 50.0, 6000.0);
    probe(&move, false, true);
    check_failure("Probing failed: no contact before the target");
    TEST_ASSERT_EQUAL_INT32(1600, stepper_position_steps(AXIS_X));
    TEST_ASSERT_TRUE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    const stepper_move_t further = to(10.0, 50.0, 6000.0);
    probe(&further, false, false);
    TEST_ASSERT_EQUAL(ERR_OK, homing_bench_finish(20)); // as wanted
    double place[AXIS_COUNT];
    TEST_ASSERT_FALSE(stepper_probed(place));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, place[AXIS_X]);
    bench_end();

    begin(4100);
    const stepper_move_t kept = to(45.0, 50.0, 6000.0);
    probe(&kept, true, true);
    check_failure("Probing failed: contact not lost before the target");
    bench_end();
}

static void test_contact_at_the_start(void) {
    for (unsigned must_change = 0; must_change < 2; must_change++) {
        const stepper_move_t move = to(20.0, 50.0, 6000.0);
        begin(4000);
        probe(&move, false, must_change != 0);
        check_failure("Probing failed: the probe has contact already");
        TEST_ASSERT_EQUAL_INT32(4000, stepper_position_steps(AXIS_X));
        bench_end();
        begin(0);
        probe(&move, true, must_change != 0);
        check_failure("Probing failed: the probe has no contact to lose");
        bench_end();
    }
}

static void test_stops(void) {
    const stepper_move_t move = to(-20.0, 50.0, 3000.0);
    begin(0);
    probe(&move, false, true);
    stepper_background();
    bench_wait_us(300000);
    stepper_stop();
    check_failure("Probing stopped");
    TEST_ASSERT_TRUE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    bench_end();

    begin(0);
    probe(&move, false, true);
    stepper_background();
    bench_wait_us(300000);
    host_pads_drive(BENCH_ESTOP_GPIO, false);
    check_failure("Probing failed: E-STOP");
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    TEST_ASSERT_FALSE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    bench_end();
}

static void test_what_is_refused(void) {
    begin(0);
    const stepper_move_t move = to(20.0, 50.0, 3000.0);
    stepper_move_t turn = to(50.0, 50.0, 3000.0);
    TEST_ASSERT_EQUAL(ERR_PROBE_NO_WAY, stepper_probe(&turn, false, true));
    turn.target[AXIS_A] = 90.0;
    TEST_ASSERT_EQUAL(ERR_PROBE_NO_WAY, stepper_probe(&turn, false, true));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_X, 30.0, 100.0));
    TEST_ASSERT_EQUAL(ERR_SOFT_LIMIT, stepper_probe(&move, false, true));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_X, 0.0, 100.0));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
    TEST_ASSERT_EQUAL(ERR_NOT_ARMED, stepper_probe(&move, false, true));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_probe_pin(PINS_NONE, false));
    TEST_ASSERT_EQUAL(ERR_NO_PROBE_PIN, stepper_probe(&move, false, true));
    TEST_ASSERT_NULL(pins_owner(PROBE_GPIO));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, stepper_probe_pin(bench_axes[AXIS_X].step_gpio, false));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_probe_pin(PROBE_GPIO, false));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_probe_pin(PROBE_GPIO, false)); // again
    TEST_ASSERT_EQUAL_INT64(4000, bench.motors[AXIS_X].position_steps);
    bench_end();
    TEST_ASSERT_NULL(pins_owner(PROBE_GPIO));
    TEST_ASSERT_EQUAL(ERR_STEPPER_NOT_INITIALIZED, stepper_probe(&move, false, true));
}

int main(void) {
    UNITY_BEGIN();
    for (unsigned curved = 0; curved < 2; curved++) {
        homing_bench_scurve(curved != 0);
        RUN_TEST(test_the_place_is_exact_at_any_speed);
        RUN_TEST(test_the_place_is_exact_with_an_scurve);
        RUN_TEST(test_contact_can_be_lost);
        RUN_TEST(test_active_high);
        RUN_TEST(test_the_queue_before_and_moves_behind);
        RUN_TEST(test_no_contact_before_the_target);
        RUN_TEST(test_contact_at_the_start);
        RUN_TEST(test_stops);
        RUN_TEST(test_what_is_refused);
    }
    return UNITY_END();
}
