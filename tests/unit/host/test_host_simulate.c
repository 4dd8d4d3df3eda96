// The simulated axis and its switch, and that their faults show.
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "simulate.h"

#define STEP 2u
#define DIR 3u
#define LIMIT 16u

static simulate_axis_t axis = {.step_gpio = STEP, .dir_gpio = DIR};
static simulate_switch_t limit = {
    .axis = &axis, .gpio = LIMIT, .from_steps = -1000, .to_steps = -5, .pressed_level = false};

void setUp(void) {
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

int main(void) {
    UNITY_BEGIN();
    hal_pin_output(STEP, false);
    hal_pin_output(DIR, true);
    hal_pin_input(LIMIT, HAL_PULL_UP);
    simulate_axis_attach(&axis);
    simulate_switch_attach(&limit);
    RUN_TEST(test_switch_closes_and_opens_on_its_steps);
    RUN_TEST(test_broken_wire_and_stuck_switch);
    RUN_TEST(test_missed_steps_move_the_switch_point);
    return UNITY_END();
}
