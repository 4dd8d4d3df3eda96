// Levels of the pads, what the edge file says about them, and the simulated axis.
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_trace.h"
#include "simulate.h"

#define BIT(gpio) (1u << (gpio))

static const char *trace_path;

void setUp(void) {
    fixture_reset();
    trace_path = fixture_file("edges.csv", "", 0);
    host_trace_open(trace_path);
}

void tearDown(void) {
    for (unsigned gpio = 0; gpio < 8; gpio++) {
        hal_pin_release(gpio);
    }
    host_trace_close();
}

// Compares the rows since setUp() with `expected`, whose times are microseconds since `start_ns`.
static void assert_edges(const char *expected) {
    char rows[1024];
    host_trace_close();
    fixture_read(trace_path, rows, sizeof rows);
    TEST_ASSERT_EQUAL_STRING_LEN("time_ns,gpio,level\n", rows, 19);
    TEST_ASSERT_EQUAL_STRING(expected, rows + 19);
}

static uint64_t at_us(uint64_t time_us) {
    host_clock_set_ns(time_us * 1000);
    return time_us;
}

static void test_outputs_follow_set_and_clear(void) {
    at_us(100);
    hal_pin_output(2, false);
    hal_pin_output(3, false);
    hal_pins_set(BIT(2) | BIT(3) | BIT(4)); // 4 is not an output
    TEST_ASSERT_EQUAL_HEX32(BIT(2) | BIT(3), hal_pins_read());
    at_us(101);
    hal_pins_set(BIT(2)); // no change, no row
    hal_pins_clear(BIT(3));
    TEST_ASSERT_EQUAL_HEX32(BIT(2), hal_pins_read());
    assert_edges("100000,2,1\n100000,3,1\n101000,3,0\n");
}

static void test_first_level_of_an_output_is_an_edge_only_if_it_changes_the_pad(void) {
    at_us(200);
    hal_pin_input(1, HAL_PULL_UP);
    hal_pin_output(1, true);
    hal_pin_output(2, false);
    hal_pin_output(3, true);
    hal_pin_input(4, HAL_PULL_UP);
    hal_pin_output(4, false);
    assert_edges("200000,3,1\n200000,4,0\n");
}

static void test_giving_a_high_output_back_is_an_edge(void) {
    at_us(300);
    hal_pin_output(2, true);
    at_us(301);
    hal_pin_release(2);
    TEST_ASSERT_EQUAL_HEX32(0, hal_pins_read());
    hal_pin_output(3, true);
    hal_pin_input(3, HAL_PULL_UP);
    assert_edges("300000,2,1\n301000,2,0\n301000,3,1\n");
}

static void test_pulls(void) {
    hal_pin_input(5, HAL_PULL_UP);
    TEST_ASSERT_EQUAL_HEX32(BIT(5), hal_pins_read());
    hal_pin_input(5, HAL_PULL_DOWN);
    TEST_ASSERT_EQUAL_HEX32(0, hal_pins_read());
    hal_pin_input(5, HAL_PULL_UP);
    hal_pin_release(5);
    TEST_ASSERT_EQUAL_HEX32(0, hal_pins_read());
    assert_edges("");
}

// On GPIO 7, which stays driven for the rest of this program.
static void test_outside_world_beats_the_pull_and_yields_to_an_output(void) {
    hal_pin_input(7, HAL_PULL_UP);
    host_pads_drive(7, false);
    TEST_ASSERT_EQUAL_HEX32(0, hal_pins_read());
    at_us(400);
    hal_pin_output(7, true);
    TEST_ASSERT_EQUAL_HEX32(BIT(7), hal_pins_read());
    host_pads_drive(7, true); // under an output: no edge, but remembered
    hal_pins_clear(BIT(7));
    hal_pin_input(7, HAL_PULL_NONE);
    TEST_ASSERT_EQUAL_HEX32(BIT(7), hal_pins_read());
    host_pads_drive(7, false); // an input's edge is not recorded
    assert_edges("400000,7,1\n400000,7,0\n400000,7,1\n");
}

static void test_edges_of_a_long_run_are_complete(void) {
    char rows[200000];
    hal_pin_output(2, false);
    for (uint64_t i = 1; i <= 5000; i++) { // more than the recorder's buffer holds
        host_clock_set_ns(1000000000u + i);
        hal_pins_set(BIT(2));
        hal_pins_clear(BIT(2));
    }
    host_trace_close();
    size_t size = fixture_read(trace_path, rows, sizeof rows);
    TEST_ASSERT_EQUAL_size_t(19 + 10000 * 15, size);
    TEST_ASSERT_EQUAL_STRING("1000005000,2,1\n1000005000,2,0\n", rows + size - 30);
}

static void pulse(unsigned gpio) {
    hal_pins_set(BIT(gpio));
    hal_pins_clear(BIT(gpio));
}

static void test_simulated_axis_counts_in_both_directions(void) {
    static simulate_axis_t axis = {.step_gpio = 2, .dir_gpio = 3};
    static simulate_axis_t mirrored = {.step_gpio = 2, .dir_gpio = 3, .dir_inverted = true};
    hal_pin_output(2, false);
    hal_pin_output(3, false);
    TEST_ASSERT_TRUE(simulate_axis_attach(&axis));
    TEST_ASSERT_TRUE(simulate_axis_attach(&mirrored));
    at_us(5000000);
    hal_pins_set(BIT(3));
    for (int i = 0; i < 10; i++) {
        pulse(2);
    }
    hal_pins_clear(BIT(3));
    pulse(2);
    TEST_ASSERT_EQUAL_INT64(9, axis.position_steps);
    TEST_ASSERT_EQUAL_INT64(-9, mirrored.position_steps);
    TEST_ASSERT_EQUAL_UINT64(11, axis.pulses);
    TEST_ASSERT_EQUAL_UINT64(5000000000u, axis.last_step_ns);
}

static void test_fault_misses_every_nth_step(void) {
    static simulate_axis_t axis = {.step_gpio = 4,
                                   .dir_gpio = 5,
                                   .fault = SIMULATE_FAULT_MISS_STEPS,
                                   .fault_every = 4,
                                   .position_steps = 100};
    hal_pin_output(4, false);
    hal_pin_output(5, true);
    TEST_ASSERT_TRUE(simulate_axis_attach(&axis));
    for (int i = 0; i < 12; i++) {
        pulse(4);
    }
    TEST_ASSERT_EQUAL_INT64(109, axis.position_steps);
    axis.fault = SIMULATE_FAULT_NONE;
    pulse(4);
    TEST_ASSERT_EQUAL_INT64(110, axis.position_steps);
}

static void use_gpio_30(void *argument) {
    (void)argument;
    hal_pin_output(30, true);
}

static void test_a_pin_that_does_not_exist_is_reported(void) {
    char message[200];
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(use_gpio_30, NULL, message, sizeof message));
    TEST_ASSERT_EQUAL_STRING("stepmite: the firmware used GPIO 30, which does not exist\n",
                             message);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_outputs_follow_set_and_clear);
    RUN_TEST(test_first_level_of_an_output_is_an_edge_only_if_it_changes_the_pad);
    RUN_TEST(test_giving_a_high_output_back_is_an_edge);
    RUN_TEST(test_pulls);
    RUN_TEST(test_outside_world_beats_the_pull_and_yields_to_an_output);
    RUN_TEST(test_edges_of_a_long_run_are_complete);
    RUN_TEST(test_simulated_axis_counts_in_both_directions);
    RUN_TEST(test_fault_misses_every_nth_step);
    RUN_TEST(test_a_pin_that_does_not_exist_is_reported);
    return UNITY_END();
}
