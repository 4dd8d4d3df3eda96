// PWM: dividers for every frequency, levels in time, what a slice's pins do when it stops.
#include <math.h>
#include <unity.h>

#include "fixture.h"
#include "hal/slices.h"
#include "host_clock.h"
#include "io/io.h"

#define PICO_HZ 125000000u
#define PICO2_HZ 150000000u

void setUp(void) {
    fixture_reset();
    io_reset();
}
void tearDown(void) {}

static void check_division(uint32_t clock_hz, double frequency_hz, bool phase_correct) {
    hal_pwm_t pwm = {0};
    double made_hz = slices_divide(clock_hz, frequency_hz, phase_correct, &pwm);
    TEST_ASSERT_TRUE(made_hz > 0.0);
    double counts = pwm.top + 1.0;
    double half = phase_correct ? 2.0 : 1.0;
    double by_registers = clock_hz / (pwm.divider_16ths / 16.0) / counts / half;
    TEST_ASSERT_DOUBLE_WITHIN(by_registers * 1e-12, by_registers, made_hz);
    TEST_ASSERT_TRUE(pwm.divider_16ths >= 16 && pwm.divider_16ths <= 4095);
    TEST_ASSERT_TRUE(pwm.top <= 65534);
    // No more than half a count off, and no frequency that more counts could have.
    TEST_ASSERT_TRUE(fabs(made_hz / frequency_hz - 1.0) <= 0.5 / counts + 1e-9);
    double most = fmin(65535.0, clock_hz / frequency_hz / half);
    TEST_ASSERT_TRUE(counts >= most * 0.9 - 1.0);
}

static void test_every_frequency_in_reach_is_met(void) {
    for (double hz = 8.0; hz < 31e6; hz *= 1.0173) {
        check_division(PICO_HZ, hz, false);
        check_division(PICO_HZ, hz / 2.0, true);
        check_division(PICO2_HZ, hz * 1.2, false);
    }
}

static void test_round_frequencies_are_exact(void) {
    static const double round_hz[] = {50, 100, 500, 1000, 2000, 5000, 20000, 25000, 100000, 1e6};
    for (size_t i = 0; i < COUNT_OF_ARRAY(round_hz); i++) {
        hal_pwm_t pwm = {0};
        double made_hz = slices_divide(PICO_HZ, round_hz[i], false, &pwm);
        TEST_ASSERT_DOUBLE_WITHIN(round_hz[i] * 1e-9, round_hz[i], made_hz);
    }
}

static void test_frequencies_out_of_reach(void) {
    hal_pwm_t pwm = {.top = 7};
    double lowest_hz = slices_lowest_hz(PICO_HZ);
    double highest_hz = slices_highest_hz(PICO_HZ);
    TEST_ASSERT_TRUE(slices_divide(PICO_HZ, lowest_hz * 1.0001, false, &pwm) > 0.0);
    TEST_ASSERT_TRUE(slices_divide(PICO_HZ, highest_hz, false, &pwm) > 0.0);
    TEST_ASSERT_EQUAL_UINT(3, pwm.top);
    static const double wrong[] = {0.0, -1.0, 7.0, 32e6, 1e300, NAN};
    for (size_t i = 0; i < COUNT_OF_ARRAY(wrong); i++) {
        TEST_ASSERT_TRUE(slices_divide(PICO_HZ, wrong[i], false, &pwm) == 0.0);
    }
    TEST_ASSERT_EQUAL_UINT(3, pwm.top); // a refused one changes nothing
}

static bool level(unsigned gpio) {
    return (hal_pins_read() & pins_mask(gpio)) != 0;
}

// Share of the next `us` in which the pin is high, looked at every 0.1 us.
static double high_share(unsigned gpio, unsigned us) {
    unsigned high = 0;
    for (unsigned i = 0; i < us * 10; i++) {
        host_clock_set_ns(host_clock_now_ns() + 100);
        high += level(gpio);
    }
    return high / (us * 10.0);
}

static void test_levels_follow_the_percentage(void) {
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(2, IO_PWM_ANY));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(3, 3)); // PWM1B
    io_pwm_t pwm = {.frequency_hz = 10000, .given = {true, true}, .percent = {25, -30}};
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(1, &pwm));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0.25, high_share(2, 1000));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0.70, high_share(3, 1000)); // inverted
    pwm = (io_pwm_t){.frequency_hz = 2000, .given = {false, true}, .percent = {0, 100}};
    pwm.phase_correct = true;
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(1, &pwm));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0.25, high_share(2, 1000)); // keeps its share
    TEST_ASSERT_TRUE(high_share(3, 1000) == 1.0);
    pwm.given[0] = true;
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(1, &pwm));
    TEST_ASSERT_TRUE(high_share(2, 1000) == 0.0);
}

static void test_stopped_slices_are_low(void) {
    io_pwm_t pwm = {.frequency_hz = 1000, .given = {true, false}, .percent = {100, 0}};
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(4, IO_PWM_ANY));
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(2, &pwm));
    TEST_ASSERT_TRUE(level(4));
    io_pwm_off(2);
    TEST_ASSERT_FALSE(level(4));
    pwm.defer = true;
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(2, &pwm));
    TEST_ASSERT_FALSE(level(4));
    double percent[HAL_PWM_SLICES] = {0};
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm_sync(1u << 2, percent));
    TEST_ASSERT_TRUE(level(4));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_off(4));
    TEST_ASSERT_FALSE(level(4));
    TEST_ASSERT_EQUAL(ERR_PWM_NOT_SET_UP, io_pwm_sync(1u << 2, percent));
    TEST_ASSERT_NULL(pins_owner(4));
}

static void test_synchronous_start_at_different_places(void) {
    io_pwm_t pwm = {.frequency_hz = 1000, .given = {true, false}, .percent = {50, 0}};
    pwm.defer = true;
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(8, IO_PWM_ANY));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(10, IO_PWM_ANY));
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(4, &pwm));
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm(5, &pwm));
    double percent[HAL_PWM_SLICES] = {[4] = 0, [5] = 50};
    TEST_ASSERT_EQUAL(ERR_OK, io_pwm_sync(1u << 4 | 1u << 5, percent));
    for (unsigned i = 0; i < 999;
         i++) { // opposite phases: never equal, but for rounding at the edges
        host_clock_set_ns(host_clock_now_ns() + 7013);
        TEST_ASSERT_NOT_EQUAL(level(8), level(10));
    }
}

static void test_servo_pulses(void) {
    const bool given[2] = {true, false};
    static const double positions[] = {-20, 0, 50, 100, 120};
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(6, IO_PWM_ANY));
    for (size_t i = 0; i < COUNT_OF_ARRAY(positions); i++) {
        const double percent[2] = {positions[i], 0};
        TEST_ASSERT_EQUAL(ERR_OK, io_servo(3, given, percent));
        double pulse_ms = high_share(6, 20000) * 20.0;
        TEST_ASSERT_DOUBLE_WITHIN(0.002, 1.0 + positions[i] / 100.0, pulse_ms);
    }
}

static void test_wrong_pins(void) {
    io_pwm_t pwm = {.frequency_hz = 1000, .given = {true, true}, .percent = {10, 20}};
    TEST_ASSERT_EQUAL(ERR_PWM_NO_PIN, io_pwm(1, &pwm));
    TEST_ASSERT_EQUAL(ERR_OK, io_set_pwm(2, IO_PWM_ANY));
    TEST_ASSERT_EQUAL(ERR_PWM_NO_PIN, io_pwm(1, &pwm)); // there is no B
    TEST_ASSERT_EQUAL_STRING("PWM1B has no pin (use SETPIN with PWM)", err_message());
    TEST_ASSERT_EQUAL(ERR_PIN_OTHER_PWM, io_set_pwm(4, 3));
    TEST_ASSERT_EQUAL_STRING("GP4 (pin 6) is PWM2A", err_message());
    TEST_ASSERT_EQUAL(ERR_PIN_OTHER_PWM, io_set_pwm(18, IO_PWM_ANY)); // the same output as GP2
    TEST_ASSERT_EQUAL_STRING("PWM1A is on GP2 (pin 4)", err_message());
    TEST_ASSERT_NULL(pins_owner(18));
    pwm.given[1] = false;
    pwm.frequency_hz = 1;
    TEST_ASSERT_EQUAL(ERR_PWM_FREQUENCY, io_pwm(1, &pwm));
    TEST_ASSERT_EQUAL_STRING("Frequency is out of reach (valid is 7.5 to 31250000 Hz)",
                             err_message());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_frequency_in_reach_is_met);
    RUN_TEST(test_round_frequencies_are_exact);
    RUN_TEST(test_frequencies_out_of_reach);
    RUN_TEST(test_levels_follow_the_percentage);
    RUN_TEST(test_stopped_slices_are_low);
    RUN_TEST(test_synchronous_start_at_different_places);
    RUN_TEST(test_servo_pulses);
    RUN_TEST(test_wrong_pins);
    return UNITY_END();
}
