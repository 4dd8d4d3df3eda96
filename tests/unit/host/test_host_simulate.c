// The simulated axis and its switch, and that their faults show.
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"
#include "simulate.h"

#define STEP 2u
#define DIR 3u
#define LIMIT 16u

static simulate_axis_t axis = {.step_gpio = STEP, .dir_gpio = DIR};
static simulate_switch_t limit = {
    .axis = &axis, .gpio = LIMIT, .from_steps = -1000, .to_steps = -5, .pressed_level = false};

#define STALL 17u
static simulate_switch_t stall = {.axis = &axis,
                                  .gpio = STALL,
                                  .from_steps = -1000,
                                  .to_steps = -20,
                                  .pressed_level = true,
                                  .stall_rate_hz = 1000,
                                  .hold_us = 2000};

void setUp(void) {
    axis.has_stops = false;
    limit.bounce_us = 0;
    limit.hysteresis_steps = 0;
    axis.position_steps = 0;
    axis.fault = SIMULATE_FAULT_NONE;
    limit.fault = SIMULATE_FAULT_NONE;
}
void tearDown(void) {}

static void step(unsigned count, bool up) {
    (up ? hal_pins_set : hal_pins_clear)(1u << DIR);
    for (unsigned i = 0; i < count; i++) {
        hal_pins_set(1u << STEP);
        hal_pins_clear(1u << STEP);
    }
}

static bool limit_level(void) {
    return (hal_pins_read() >> LIMIT) & 1;
}

static void test_switch_closes_and_opens_on_its_steps(void) {
    step(4, false);
    TEST_ASSERT_TRUE(limit_level());
    step(1, false);
    TEST_ASSERT_FALSE(limit_level());
    step(1, true);
    TEST_ASSERT_TRUE(limit_level());
    TEST_ASSERT_EQUAL_INT64(-4, axis.position_steps);
}

static void test_broken_wire_and_stuck_switch(void) {
    limit.fault = SIMULATE_FAULT_NEVER_CLOSES;
    step(10, false);
    TEST_ASSERT_TRUE(limit_level());
    limit.fault = SIMULATE_FAULT_NEVER_OPENS;
    step(10, true);
    TEST_ASSERT_FALSE(limit_level());
}

static void test_missed_steps_move_the_switch_point(void) {
    axis.fault = SIMULATE_FAULT_MISS_STEPS;
    axis.fault_every = 2;
    step(8, false);
    TEST_ASSERT_EQUAL_INT64(-4, axis.position_steps);
    TEST_ASSERT_TRUE(limit_level());
    step(2, false);
    TEST_ASSERT_FALSE(limit_level());
}

static void wait_us(unsigned us) {
    host_clock_run(host_clock_now_ns() + us * 1000ull, false);
}

static void test_hysteresis_opens_the_switch_further_out(void) {
    limit.hysteresis_steps = 3;
    step(5, false);
    TEST_ASSERT_FALSE(limit_level());
    step(3, true);
    TEST_ASSERT_FALSE(limit_level());
    step(1, true);
    TEST_ASSERT_TRUE(limit_level());
    step(3, false);
    TEST_ASSERT_TRUE(limit_level());
    step(1, false);
    TEST_ASSERT_FALSE(limit_level());
    step(5, true);
}

// Touches at once, opens and closes for a while, and is calm then; the same the other way.
static void test_bounces_end_in_the_new_state(void) {
    unsigned longest_us = 0;
    limit.bounce_us = 700;
    for (unsigned round = 0; round < 50; round++) {
        bool down = round % 2 == 0;
        step(5, !down);
        TEST_ASSERT_EQUAL(!down, limit_level());
        unsigned changes = 0;
        bool before = limit_level();
        for (unsigned us = 1; us <= 1000; us++) {
            wait_us(1);
            changes += limit_level() != before;
            longest_us = limit_level() != before && us > longest_us ? us : longest_us;
            before = limit_level();
        }
        TEST_ASSERT_EQUAL(!down, limit_level());
        TEST_ASSERT_GREATER_THAN_UINT32(3, changes);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(600, longest_us);
    TEST_ASSERT_LESS_THAN_UINT32(800, longest_us);
}

static void test_a_stop_swallows_steps(void) {
    axis.has_stops = true;
    axis.stop_low_steps = -3;
    axis.stop_high_steps = 100;
    step(10, false);
    TEST_ASSERT_EQUAL_INT64(-3, axis.position_steps);
    step(2, true);
    TEST_ASSERT_EQUAL_INT64(-1, axis.position_steps);
}

static void step_slowly(unsigned count, unsigned us) {
    for (unsigned i = 0; i < count; i++) {
        wait_us(us);
        step(1, false);
    }
}

static bool stall_level(void) {
    return (hal_pins_read() >> STALL) & 1;
}

static void test_a_stall_is_noticed_only_at_speed(void) {
    step_slowly(40, 1100);
    TEST_ASSERT_FALSE(stall_level());
    step_slowly(2, 900);
    TEST_ASSERT_TRUE(stall_level());
    wait_us(1900);
    TEST_ASSERT_TRUE(stall_level());
    wait_us(200);
    TEST_ASSERT_FALSE(stall_level());
}

int main(void) {
    UNITY_BEGIN();
    hal_pin_output(STEP, false);
    hal_pin_output(DIR, true);
    hal_pin_input(LIMIT, HAL_PULL_UP);
    simulate_axis_attach(&axis);
    simulate_switch_attach(&limit);
    TEST_ASSERT_TRUE(simulate_switch_attach(&stall));
    hal_pin_input(STALL, HAL_PULL_DOWN);
    RUN_TEST(test_switch_closes_and_opens_on_its_steps);
    RUN_TEST(test_broken_wire_and_stuck_switch);
    RUN_TEST(test_missed_steps_move_the_switch_point);
    RUN_TEST(test_hysteresis_opens_the_switch_further_out);
    RUN_TEST(test_bounces_end_in_the_new_state);
    RUN_TEST(test_a_stop_swallows_steps);
    RUN_TEST(test_a_stall_is_noticed_only_at_speed);
    return UNITY_END();
}
