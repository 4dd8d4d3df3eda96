// The monitor: who is asked when, and what is told of it, once.
#include "bench.h"

#include <string.h>
#include <unity.h>

#include "hal/hal.h"
#include "tmc22xx/tmc22xx_registers.h"

#define NAME "TMC2209 at address 0 on GP16 (pin 21), axis X "
#define SECOND_US 1000000u

static line_chip_t *chip;
static unsigned driver;
static char event[160];

void setUp(void) {
    line_reset();
    tmc22xx_monitor(true);
    chip = line_add(BENCH_WIRE, 0);
    driver = bench_set_up(BENCH_WIRE, 0);
    tmc22xx_tie(driver, 0);
    line_expect(NULL);
}
void tearDown(void) {}

// Lets the main loop come round every 10 ms, or when the wire wants it.
static void pass(uint64_t time_us) {
    uint64_t end_us = line.time_us + time_us;
    while (line.time_us < end_us) {
        tmc22xx_background();
        uint64_t next_us = line.time_us + 10000;
        next_us = next_us < tmc22xx_wake_us() ? next_us : tmc22xx_wake_us();
        line.time_us = next_us > line.time_us ? next_us : line.time_us + 1;
    }
}

static void tells(const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(tmc22xx_next_event(event, sizeof event), text);
    TEST_ASSERT_EQUAL_STRING(text, event);
}

static void tells_nothing(void) {
    if (tmc22xx_next_event(event, sizeof event)) {
        TEST_FAIL_MESSAGE(event);
    }
}

static void test_each_is_asked_once_a_second(void) {
    for (uint8_t address = 1; address < 3; address++) {
        line_add(BENCH_WIRE, address);
        bench_set_up(BENCH_WIRE, address);
    }
    line_expect(NULL);
    pass(20 * SECOND_US);
    unsigned asked[4] = {0};
    for (size_t i = 0; i < line.frame_count; i++) {
        TEST_ASSERT_EQUAL_UINT8(4, line.frames[i].size); // nothing is written
        asked[line.frames[i].bytes[1]]++;
    }
    for (unsigned address = 0; address < 3; address++) {
        TEST_ASSERT_UINT_WITHIN(4, 40, asked[address]); // two registers
    }
    tells_nothing();
}

// A board that has nothing to do wakes every two seconds.
static void test_a_main_loop_that_sleeps(void) {
    for (uint8_t address = 1; address < 3; address++) {
        line_add(BENCH_WIRE, address);
        bench_set_up(BENCH_WIRE, address);
    }
    line_expect(NULL);
    for (unsigned i = 0; i < 10; i++) {
        line.time_us += 2 * SECOND_US;
        while (tmc22xx_wake_us() <= line.time_us || tmc22xx_busy()) {
            tmc22xx_background();
            bool waits = tmc22xx_busy() && tmc22xx_wake_us() > line.time_us;
            line.time_us = waits ? tmc22xx_wake_us() : line.time_us;
        }
    }
    TEST_ASSERT_UINT_WITHIN(6, 10 * 3 * 2, line.frame_count);
}

static void test_nobody_is_asked(void) {
    tmc22xx_monitor(false);
    pass(5 * SECOND_US);
    tmc22xx_monitor(true);
    tmc22xx_verify(false);
    pass(5 * SECOND_US);
    TEST_ASSERT_EQUAL_UINT(0, line.frame_count);
    bench_set_up(BENCH_WIRE, 0);
    tmc22xx_verify(true); // but this one was never heard
    line_expect(NULL);
    pass(5 * SECOND_US);
    TEST_ASSERT_EQUAL_UINT(0, line.frame_count);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, tmc22xx_wake_us());
}

static void test_too_hot_is_told_once(void) {
    chip->registers[TMC22XX_REG_DRV_STATUS] = TMC22XX_MASK(DRV_STATUS, otpw);
    pass(2 * SECOND_US);
    tells(NAME "is hot: less current or more cooling, or it will switch the motor off");
    pass(5 * SECOND_US);
    tells_nothing();
    for (unsigned i = 0; i < 5; i++) { // about the threshold
        chip->registers[TMC22XX_REG_DRV_STATUS] ^= TMC22XX_MASK(DRV_STATUS, otpw);
        pass(3 * SECOND_US);
        tells_nothing();
    }
    chip->registers[TMC22XX_REG_DRV_STATUS] = 0;
    pass(12 * SECOND_US);
    tells_nothing();
    chip->registers[TMC22XX_REG_DRV_STATUS] = TMC22XX_MASK(DRV_STATUS, otpw);
    pass(2 * SECOND_US);
    tells(NAME "is hot: less current or more cooling, or it will switch the motor off");
}

static void test_overheated(void) {
    chip->registers[TMC22XX_REG_DRV_STATUS] =
        TMC22XX_MASK(DRV_STATUS, otpw) | TMC22XX_MASK(DRV_STATUS, ot);
    chip->registers[TMC22XX_REG_GSTAT] = TMC22XX_MASK(GSTAT, drv_err);
    pass(2 * SECOND_US);
    tells(NAME "is overheated and has switched the motor off");
    tells_nothing();
    chip->registers[TMC22XX_REG_DRV_STATUS] = 0; // the chip keeps that there was an error
    pass(30 * SECOND_US);
    tells_nothing();
}

static void test_an_error_that_nobody_saw(void) {
    chip->registers[TMC22XX_REG_GSTAT] = TMC22XX_MASK(GSTAT, drv_err);
    pass(20 * SECOND_US);
    tells(NAME "has had the motor off for a moment: overheated, or a short circuit");
    tells_nothing();
    bench_set_up(BENCH_WIRE, 0); // clears it
    chip->registers[TMC22XX_REG_GSTAT] = TMC22XX_MASK(GSTAT, drv_err);
    pass(2 * SECOND_US);
    tells(NAME "has had the motor off for a moment: overheated, or a short circuit");
}

static void test_short_and_undervoltage(void) {
    chip->registers[TMC22XX_REG_DRV_STATUS] = TMC22XX_MASK(DRV_STATUS, s2vsb);
    chip->registers[TMC22XX_REG_GSTAT] = TMC22XX_MASK(GSTAT, uv_cp);
    pass(2 * SECOND_US);
    tells(NAME "has found a short circuit at a motor coil and has switched the motor off");
    tells(NAME "has too low a voltage and has switched the motor off: check its supply");
    tells_nothing();
}

static void test_lost_settings(void) {
    line_power_up(chip);
    pass(2 * SECOND_US);
    tells(NAME "has lost its settings (was its power off?): set it up again");
    pass(20 * SECOND_US);
    tells_nothing();
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_TRUE(info.lost);
    bench_set_up(BENCH_WIRE, 0);
    pass(20 * SECOND_US);
    tells_nothing();
    line_power_up(chip);
    pass(2 * SECOND_US);
    tells(NAME "has lost its settings (was its power off?): set it up again");
}

// A statement has said so already.
static void test_lost_settings_that_a_statement_found(void) {
    line_power_up(chip);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_current(driver, 500, -1));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_LOST, tmc22xx_result());
    pass(3 * SECOND_US);
    tells_nothing();
}

static void test_silent_and_back(void) {
    chip->gone = true;
    pass(3 * SECOND_US);
    tells(NAME "does not answer any more: check its supply and the wire");
    pass(20 * SECOND_US);
    tells_nothing();
    chip->gone = false;
    pass(5 * SECOND_US);
    tells(NAME "answers again");
    pass(20 * SECOND_US);
    tells_nothing();
}

static void test_a_loose_wire(void) {
    chip->gone = true;
    pass(3 * SECOND_US);
    tells(NAME "does not answer any more: check its supply and the wire");
    for (unsigned i = 0; i < 20; i++) {
        chip->gone = i % 2 != 0;
        pass(2 * SECOND_US);
        tells_nothing();
    }
    chip->gone = false;
    pass(5 * SECOND_US);
    tells(NAME "answers again");
}

static line_fault_t all_bad(size_t frame) {
    (void)frame;
    return LINE_BAD_CRC;
}

static void test_answers_that_cannot_be_read(void) {
    line_expect(all_bad);
    pass(3 * SECOND_US);
    tells(NAME "does not answer any more: check its supply and the wire");
    line_expect(NULL);
    pass(5 * SECOND_US);
    tells(NAME "answers again");
}

// A driver that was away when it was to be disarmed does not stay armed.
static void test_disarmed_when_it_answers_again(void) {
    tmc22xx_keep_threshold(driver, 300, true);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(1u << driver, true));
    line_run();
    chip->gone = true;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(1u << driver, false));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_arm_result());
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_TRUE(info.armed);
    TEST_ASSERT_EQUAL_UINT32(300, chip->registers[TMC22XX_REG_TCOOLTHRS]);
    chip->gone = false;
    pass(5 * SECOND_US);
    TEST_ASSERT_EQUAL_UINT32(0, chip->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_FALSE(info.armed);
    tells(NAME "answers again");
    tells_nothing();
}

// The statement goes first at the next turn, and what it has read stays.
static void test_a_statement_and_the_monitor(void) {
    chip->registers[TMC22XX_REG_SG_RESULT] = 123;
    const uint8_t reg = TMC22XX_REG_SG_RESULT;
    unsigned busy = 0;
    for (unsigned i = 0; i < 2000; i++) {
        err_t err = tmc22xx_begin_read(driver, &reg, 1);
        busy += err == ERR_TMC_BUSY;
        while (err == ERR_OK && tmc22xx_busy()) {
            line_run_until(line.time_us + 100);
        }
        pass(1000 + i % 7000);
        if (err == ERR_OK) {
            TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_result());
            TEST_ASSERT_EQUAL_UINT32(123, tmc22xx_value(0));
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(5, busy);
    TEST_ASSERT_LESS_THAN_UINT(500, busy);
}

// What is said about a driver while a job on it is under way stays said.
static void test_tied_under_way(void) {
    tmc22xx_monitor(false);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_current(driver, 500, -1));
    pass(2000);
    tmc22xx_tie(driver, 3);
    tmc22xx_keep_threshold(driver, 99, true);
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_result());
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT8(3, info.axis);
    TEST_ASSERT_EQUAL_UINT32(99, info.kept_tcoolthrs);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_each_is_asked_once_a_second);
    RUN_TEST(test_a_main_loop_that_sleeps);
    RUN_TEST(test_nobody_is_asked);
    RUN_TEST(test_too_hot_is_told_once);
    RUN_TEST(test_overheated);
    RUN_TEST(test_an_error_that_nobody_saw);
    RUN_TEST(test_short_and_undervoltage);
    RUN_TEST(test_lost_settings);
    RUN_TEST(test_lost_settings_that_a_statement_found);
    RUN_TEST(test_silent_and_back);
    RUN_TEST(test_a_loose_wire);
    RUN_TEST(test_answers_that_cannot_be_read);
    RUN_TEST(test_disarmed_when_it_answers_again);
    RUN_TEST(test_a_statement_and_the_monitor);
    RUN_TEST(test_tied_under_way);
    return UNITY_END();
}
