// Pins of a program: whose they are, values, pulses, counters, changes. The outside world drives
// some of them.
#include <unity.h>

#include "fixture.h"
#include "host_analog.h"
#include "host_clock.h"
#include "host_pads.h"
#include "io/io.h"

void setUp(void) {
    fixture_reset();
    io_reset();
}
void tearDown(void) {}

static void pass_us(uint64_t us) {
    host_clock_run(host_clock_now_ns() + us * 1000, false);
}

static int64_t whole(unsigned gpio) {
    io_value_t value = {.is_whole = false};
    TEST_ASSERT_EQUAL(ERR_OK, io_read(gpio, &value));
    TEST_ASSERT_TRUE(value.is_whole);
    return value.whole;
}

static double number(unsigned gpio) {
    io_value_t value = {.is_whole = true};
    TEST_ASSERT_EQUAL(ERR_OK, io_read(gpio, &value));
    TEST_ASSERT_FALSE(value.is_whole);
    return value.number;
}

static void test_pins_of_others_are_refused_by_name(void) {
    TEST_ASSERT_EQUAL(ERR_OK, pins_claim(5, "STEPPER X step"));
    hal_pin_output(5, true);
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_set_output(5));
    TEST_ASSERT_EQUAL_STRING("Pin GP5 (pin 7) is in use by STEPPER X step", err_message());
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_set_input(5, HAL_PULL_UP));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_set_off(5));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_set_frequency(5, 10));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_set_interrupt(5, HAL_EDGE_BOTH, HAL_PULL_NONE));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_set_pwm(5, IO_PWM_ANY));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_write(5, 0));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, io_pulse(5, 1));
    io_reset();
    TEST_ASSERT_EQUAL(1, whole(5)); // looking is allowed, and nothing has changed
    pins_disclaim(5);
    hal_pin_release(5);
}

static void test_uses_follow_each_other(void) {
    TEST_ASSERT_EQUAL(ERR_OK, io_set_output(2));
    TEST_ASSERT_EQUAL_STRING("SETPIN DOUT", pins_owner(2));
    TEST_ASSERT_EQUAL(ERR_OK, io_write(2, 77));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_output(2));
    TEST_ASSERT_EQUAL(1, whole(2)); // an output keeps its level
    TEST_ASSERT_EQUAL(ERR_OK, io_set_input(2, HAL_PULL_NONE));
    TEST_ASSERT_EQUAL_STRING("SETPIN DIN", pins_owner(2));
    TEST_ASSERT_EQUAL(0, whole(2));
    TEST_ASSERT_EQUAL(ERR_PIN_NOT_OUTPUT, io_write(2, 1));
    TEST_ASSERT_EQUAL(ERR_PIN_NOT_OUTPUT, io_pulse(2, 1));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_off(2));
    TEST_ASSERT_NULL(pins_owner(2));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_off(2));
    io_value_t value;
    TEST_ASSERT_EQUAL(ERR_PIN_NOT_SET, io_read(2, &value));
    TEST_ASSERT_EQUAL(ERR_PIN_INVALID, io_read(23, &value));
    TEST_ASSERT_EQUAL(ERR_PIN_INVALID, io_write(99, 1));
    TEST_ASSERT_EQUAL(ERR_PIN_INVALID, io_set_output(29));
}

static void test_port(void) {
    for (unsigned gpio = 6; gpio <= 8; gpio++) {
        TEST_ASSERT_EQUAL(ERR_OK, io_set_output(gpio));
    }
    uint32_t levels;
    TEST_ASSERT_EQUAL(ERR_OK, io_write_port(7u << 6, 5u << 6));
    TEST_ASSERT_EQUAL(ERR_OK, io_read_port(7u << 6, &levels));
    TEST_ASSERT_EQUAL_HEX32(5u << 6, levels);
    TEST_ASSERT_EQUAL(ERR_PIN_NOT_OUTPUT, io_write_port(15u << 6, 0));
    TEST_ASSERT_EQUAL(ERR_OK, io_read_port(7u << 6, &levels));
    TEST_ASSERT_EQUAL_HEX32(5u << 6, levels); // refused as a whole
    TEST_ASSERT_EQUAL(ERR_PIN_NOT_SET, io_read_port(15u << 6, &levels));
}

static void test_analog(void) {
    host_analog_set_volts(27, 1.1);
    TEST_ASSERT_EQUAL(ERR_OK, io_set_voltage(27));
    TEST_ASSERT_DOUBLE_WITHIN(3.3 / 4095, 1.1, number(27));
    io_set_reference(3.0);
    TEST_ASSERT_DOUBLE_WITHIN(3.3 / 4095, 1.0, number(27));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_raw(27));
    TEST_ASSERT_EQUAL(1365, whole(27));
    host_analog_set_volts(27, 5.0);
    TEST_ASSERT_EQUAL(4095, whole(27));
    TEST_ASSERT_EQUAL(ERR_PIN_NOT_ANALOG, io_set_voltage(22));
    TEST_ASSERT_NULL(pins_owner(22));
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 25.0, io_temperature());
    host_analog_set_temperature(60.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 60.0, io_temperature());
}

static void test_pulses(void) {
    for (unsigned gpio = 2; gpio <= 10; gpio++) {
        TEST_ASSERT_EQUAL(ERR_OK, io_set_output(gpio));
    }
    io_write(3, 1);
    uint64_t start_us = hal_time_us();
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(2, 0.25)); // waited for
    TEST_ASSERT_EQUAL_UINT64(start_us + 250, hal_time_us());
    TEST_ASSERT_EQUAL(0, whole(2));
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(2, 20));
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(3, 10));
    TEST_ASSERT_EQUAL(1, whole(2));
    TEST_ASSERT_EQUAL(0, whole(3));
    pass_us(9999);
    TEST_ASSERT_EQUAL(0, whole(3));
    pass_us(1);
    TEST_ASSERT_EQUAL(1, whole(3));
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(2, 15)); // anew: 25 ms in all
    pass_us(14999);
    TEST_ASSERT_EQUAL(1, whole(2));
    pass_us(1);
    TEST_ASSERT_EQUAL(0, whole(2));
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(2, 1000));
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(2, 0));
    TEST_ASSERT_EQUAL(0, whole(2));
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(2, 5));
    TEST_ASSERT_EQUAL(ERR_OK, io_write(2, 1)); // whoever sets the pin has it as he wants
    pass_us(10000);
    TEST_ASSERT_EQUAL(1, whole(2));
    for (unsigned gpio = 2; gpio < 2 + IO_PULSES; gpio++) {
        TEST_ASSERT_EQUAL(ERR_OK, io_pulse(gpio, 5));
    }
    TEST_ASSERT_EQUAL(ERR_TOO_MANY_PULSES, io_pulse(10, 5));
    TEST_ASSERT_EQUAL(0, whole(10));
    io_set_off(4); // its pulse must not end on whoever has the pin then
    hal_pin_output(4, true);
    pass_us(5000);
    TEST_ASSERT_EQUAL_HEX32(1u << 4, hal_pins_read() & 1u << 4);
    hal_pin_release(4);
    TEST_ASSERT_EQUAL(ERR_OK, io_pulse(10, 5));
}

// Pulses on a pin from outside: `count` times `high_us` high and `low_us` low.
static void drive(unsigned gpio, unsigned count, unsigned high_us, unsigned low_us) {
    for (unsigned i = 0; i < count; i++) {
        host_pads_drive(gpio, true);
        pass_us(high_us);
        host_pads_drive(gpio, false);
        pass_us(low_us);
    }
}

static void test_counting(void) {
    host_pads_drive(12, false);
    TEST_ASSERT_EQUAL(ERR_OK, io_set_counter(12, HAL_EDGE_RISING, HAL_PULL_DOWN));
    drive(12, 10, 3, 4);
    TEST_ASSERT_EQUAL(10, whole(12));
    TEST_ASSERT_EQUAL(ERR_OK, io_write(12, -3));
    drive(12, 10, 3, 4);
    TEST_ASSERT_EQUAL(7, whole(12));
    pass_us(200000000); // over the gates that widen the counter
    drive(12, 1, 3, 4);
    TEST_ASSERT_EQUAL(8, whole(12));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_counter(12, HAL_EDGE_BOTH, HAL_PULL_DOWN));
    drive(12, 10, 3, 4);
    TEST_ASSERT_EQUAL(20, whole(12));
}

static void test_frequency_and_period(void) {
    host_pads_drive(13, false);
    TEST_ASSERT_EQUAL(ERR_OK, io_set_frequency(13, 50));
    TEST_ASSERT_TRUE(number(13) == 0.0); // no gate has closed
    drive(13, 200, 100, 300);
    TEST_ASSERT_TRUE(number(13) == 2500.0);
    pass_us(100000);
    TEST_ASSERT_TRUE(number(13) == 0.0); // the signal has gone
    TEST_ASSERT_EQUAL(ERR_OK, io_set_period(13, 5));
    TEST_ASSERT_TRUE(number(13) == 0.0);
    drive(13, 20, 100, 300);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.4, number(13));
}

static void test_four_counters(void) {
    for (unsigned gpio = 14; gpio <= 17; gpio++) {
        TEST_ASSERT_EQUAL(ERR_OK, io_set_frequency(gpio, 1000));
    }
    TEST_ASSERT_EQUAL(ERR_TOO_MANY_COUNTERS, io_set_period(18, 1));
    TEST_ASSERT_NULL(pins_owner(18));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_period(15, 1)); // its own is enough
    TEST_ASSERT_EQUAL(ERR_OK, io_set_off(16));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_counter(18, HAL_EDGE_BOTH, HAL_PULL_NONE));
}

static void test_changes(void) {
    host_pads_drive(19, true);
    host_pads_drive(20, false);
    TEST_ASSERT_EQUAL(ERR_OK, io_set_interrupt(19, HAL_EDGE_FALLING, HAL_PULL_UP));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_interrupt(20, HAL_EDGE_RISING, HAL_PULL_NONE));
    TEST_ASSERT_EQUAL_HEX32(0, io_changed());
    drive(20, 3, 1, 1);
    TEST_ASSERT_EQUAL_HEX32(1u << 20, io_changed()); // several are one
    TEST_ASSERT_EQUAL_HEX32(0, io_changed());
    host_pads_drive(19, false);
    TEST_ASSERT_EQUAL_HEX32(1u << 19, io_changed());
    host_pads_drive(19, true);
    TEST_ASSERT_EQUAL_HEX32(0, io_changed());
    TEST_ASSERT_EQUAL(1, whole(19));
    drive(20, 1, 1, 1);
    TEST_ASSERT_EQUAL(ERR_OK, io_set_off(20));
    drive(20, 1, 1, 1);
    TEST_ASSERT_EQUAL_HEX32(0, io_changed());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_pins_of_others_are_refused_by_name);
    RUN_TEST(test_uses_follow_each_other);
    RUN_TEST(test_port);
    RUN_TEST(test_analog);
    RUN_TEST(test_pulses);
    RUN_TEST(test_counting);
    RUN_TEST(test_frequency_and_period);
    RUN_TEST(test_four_counters);
    RUN_TEST(test_changes);
    return UNITY_END();
}
