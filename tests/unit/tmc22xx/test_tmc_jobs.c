// Jobs for drivers that are set up, on wires in memory: changes, reading, several wires, homing,
// giving up.
#include "bench.h"

#include <unity.h>

#include "hal/hal.h"
#include "tmc22xx/tmc22xx_registers.h"

void setUp(void) {
    line_reset();
}
void tearDown(void) {}

// ---- Changes ------------------------------------------------------------------------------------

static void test_changes_start_from_what_was_written(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_CHOPCONF, 0x14030155)); // TOFF 5
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_IHOLD_IRUN, 0x00031008));
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 520, tmc22xx_driver(driver)->run_ma);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 50, tmc22xx_driver(driver)->hold_percent);
    bench_succeeds(tmc22xx_set_current(driver, 1000, -1));
    TEST_ASSERT_EQUAL_HEX32(0x14010155, chip->registers[TMC22XX_REG_CHOPCONF]);
    TEST_ASSERT_EQUAL_HEX32(0x00031108, chip->registers[TMC22XX_REG_IHOLD_IRUN]);
    bench_succeeds(tmc22xx_set_stealth(driver, false, 0));
    TEST_ASSERT_EQUAL_HEX32(0x1C4, chip->registers[TMC22XX_REG_GCONF]);
    TEST_ASSERT_FALSE(tmc22xx_driver(driver)->stealth);
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_GCONF, 0x1C8)); // turned round
    bench_succeeds(tmc22xx_set_stealth(driver, false, 100));
    TEST_ASSERT_EQUAL_HEX32(0x1CC, chip->registers[TMC22XX_REG_GCONF]);
    TEST_ASSERT_EQUAL_HEX32(100, chip->registers[TMC22XX_REG_TPWMTHRS]);
}

// From 1000 to 900 mA the scale rises from 17 to 28 in the finer range.
static void test_the_current_is_never_above_both(void) {
    line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    bench_succeeds(tmc22xx_set_current(driver, 1000, 100));
    line_expect(NULL);
    bench_succeeds(tmc22xx_set_current(driver, 900, 100));
    TEST_ASSERT_EQUAL_STRING("R02 W6C 14030153 R02 W10 00081C1C R02 R01 ", bench_sent());
    line_expect(NULL);
    bench_succeeds(tmc22xx_set_current(driver, 1000, 100));
    TEST_ASSERT_EQUAL_STRING("R02 W10 00081111 R02 W6C 14010153 R02 R01 ", bench_sent());
}

static void test_reading(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    chip->registers[TMC22XX_REG_SG_RESULT] = 0x12C;
    chip->registers[TMC22XX_REG_DRV_STATUS] = 0xC0190000;
    const uint8_t registers[] = {TMC22XX_REG_SG_RESULT, TMC22XX_REG_DRV_STATUS};
    bench_succeeds(tmc22xx_begin_read(driver, registers, 2));
    TEST_ASSERT_EQUAL_HEX32(0x12C, tmc22xx_value(0));
    TEST_ASSERT_EQUAL_HEX32(0xC0190000, tmc22xx_value(1));
    TEST_ASSERT_EQUAL_HEX32(0, tmc22xx_value(2));
}

// The user still gets what was read, and is told beside it.
static void test_reading_a_driver_that_was_reset(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    line_power_up(chip);
    const uint8_t reg = TMC22XX_REG_GCONF;
    bench_succeeds(tmc22xx_begin_read(driver, &reg, 1));
    TEST_ASSERT_EQUAL_HEX32(0x101, tmc22xx_value(0));
    char text[160];
    TEST_ASSERT_TRUE(tmc22xx_next_event(text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("TMC2209 at address 0 on GP16 (pin 21) has lost its settings (was its "
                             "power off?): set it up again",
                             text);
    TEST_ASSERT_FALSE(tmc22xx_next_event(text, sizeof text));
}

static void test_what_cannot_be_asked_for(void) {
    line_add(BENCH_WIRE, 0);
    bench_refused(tmc22xx_begin_write(0, TMC22XX_REG_GCONF, 0),
                  "TMC22xx not initialized (no such driver)");
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    bench_refused(tmc22xx_begin_write(driver, TMC22XX_REG_IFCNT, 0), "IFCNT can only be read");
    bench_refused(tmc22xx_begin_write(driver, TMC22XX_REG_OTP_PROG, 0xBD00),
                  "OTP_PROG cannot be undone and is not written");
    bench_refused(tmc22xx_begin_write(driver, 0x7E, 0), "There is no register 0x7E");
    bench_refused(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 256),
                  "SGTHRS takes values up to 0xFF");
    bench_refused(tmc22xx_begin_write(driver, TMC22XX_REG_VACTUAL, 0xFF7FFFFF),
                  "VACTUAL takes values up to 0xFFFFFF");
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_VACTUAL, (uint32_t)-0x800000));
    TEST_ASSERT_EQUAL_HEX32(0x800000, line.chips[0].registers[TMC22XX_REG_VACTUAL]);
    const uint8_t registers[] = {TMC22XX_REG_SGTHRS};
    bench_refused(tmc22xx_begin_read(driver, registers, 1), "SGTHRS can only be written");
    bench_refused(tmc22xx_set_current(driver, 0, 0),
                  "Motor current 0 mA is too little (the least is 30.6 mA)");
}

static void test_one_job_at_a_time(void) {
    line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_current(driver, 500, -1));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_set_current(driver, 600, -1));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_set_up(&bench_usual));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_wire(BENCH_OTHER_WIRE, BENCH_OTHER_WIRE, 9600));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_begin_arm(1, true));
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_result());
    TEST_ASSERT_EQUAL_DOUBLE(500, tmc22xx_driver(driver)->run_ma);
}

// ---- Wires --------------------------------------------------------------------------------------

static void test_two_wires_and_two_addresses(void) {
    line_add(BENCH_WIRE, 0);
    line_add(BENCH_WIRE, 1);
    line_add(BENCH_OTHER_WIRE, 0);
    bench_set_up(BENCH_WIRE, 0);
    unsigned second = bench_set_up(BENCH_WIRE, 1);
    unsigned third = bench_set_up(BENCH_OTHER_WIRE, 0);
    unsigned driver;
    TEST_ASSERT_EQUAL(ERR_TMC_SEVERAL, tmc22xx_find(0, PINS_NONE, &driver));
    TEST_ASSERT_EQUAL_STRING("Address 0 is on GP16 (pin 21) and on GP5 (pin 7): name the pin or "
                             "the axis",
                             err_message());
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_find(1, PINS_NONE, &driver));
    TEST_ASSERT_EQUAL_UINT(second, driver);
    tmc22xx_tie(third, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_find_axis(0, &driver));
    TEST_ASSERT_EQUAL_UINT(third, driver);
    bench_refused(tmc22xx_find(3, PINS_NONE, &driver),
                  "TMC22xx not initialized (no driver at address 3)");
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_close(BENCH_WIRE));
    TEST_ASSERT_NULL(pins_owner(BENCH_WIRE));
    TEST_ASSERT_NULL(tmc22xx_driver(second));
    TEST_ASSERT_NOT_NULL(tmc22xx_driver(third));
    bench_refused(tmc22xx_close(BENCH_WIRE), "TMC22xx not initialized (no wire on GP16 (pin 21))");
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_close(PINS_NONE));
    bench_refused(tmc22xx_close(PINS_NONE), "TMC22xx not initialized (no wire)");
}

static line_fault_t all_held_low(size_t frame) {
    (void)frame;
    return LINE_HELD_LOW;
}

// The pin that listens is named where it matters.
static void test_no_answer_at_a_pin_of_its_own(void) {
    tmc22xx_settings_t usual = bench_settings(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_wire(BENCH_WIRE, 17, 115200));
    bench_fails(tmc22xx_set_up(&usual), "No answer from address 0 on GP16 (pin 21): check motor "
                                        "supply, wire to PDN_UART, wire back to GP17 (pin 22)");
    line_expect(all_held_low);
    bench_fails(tmc22xx_set_up(&usual),
                "The line GP17 (pin 22) is held low: is the driver powered?");
    line_expect(NULL);
}

static void test_a_wire_with_two_pins(void) {
    line_add(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_wire(BENCH_WIRE, 17, 9600));
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT8(17, info.rx_gpio);
    TEST_ASSERT_EQUAL_UINT32(9600, info.baud);
    TEST_ASSERT_EQUAL_STRING("TMC22xx wire", pins_owner(17));
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_wire(BENCH_WIRE, BENCH_WIRE, 115200)); // the driver stays
    TEST_ASSERT_NULL(pins_owner(17));
    TEST_ASSERT_EQUAL_STRING("TMC22xx wire", pins_owner(BENCH_WIRE));
    bench_succeeds(tmc22xx_set_current(driver, 500, -1));
    pins_claim(18, "somebody");
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, tmc22xx_wire(BENCH_WIRE, 18, 115200));
    bench_succeeds(tmc22xx_set_current(driver, 600, -1));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, tmc22xx_wire(20, 18, 115200));
    TEST_ASSERT_NULL(pins_owner(20));
    pins_disclaim(18);
    TEST_ASSERT_EQUAL(ERR_ARGUMENT, tmc22xx_wire(BENCH_WIRE, BENCH_WIRE, 9599));
}

// What goes wrong with one driver does not count for another.
static void test_the_counters_of_a_driver(void) {
    line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    tmc22xx_settings_t other = bench_settings(BENCH_WIRE, 3); // there is none
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&other));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_result());
    other = bench_settings(BENCH_WIRE, 0);
    other.chip = 2208;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&other));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_WRONG_CHIP, tmc22xx_result());
    bench_succeeds(tmc22xx_set_current(driver, 500, -1));
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT16(0, info.repeats);
    TEST_ASSERT_EQUAL_UINT16(0, info.failures);
}

static void test_no_more_than_eight(void) {
    for (uint8_t i = 0; i < 8; i++) {
        line_add((uint8_t)(10 + i / 4), i % 4);
        bench_set_up((uint8_t)(10 + i / 4), i % 4);
    }
    tmc22xx_settings_t settings = bench_settings(20, 0);
    bench_refused(tmc22xx_set_up(&settings), "Too many TMC22xx drivers (at most 8)");
    TEST_ASSERT_NULL(pins_owner(20));
    bench_set_up(10, 3); // again is fine
}

// Wherever the wire closes, nothing is left of the job.
static void test_a_wire_that_closes_under_a_job(void) {
    for (uint64_t after_us = 0; after_us < 24000; after_us += 173) {
        line_reset();
        line_add(BENCH_WIRE, 0);
        line_add(BENCH_OTHER_WIRE, 0);
        bench_set_up(BENCH_OTHER_WIRE, 0);
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&bench_usual));
        line_run_until(line.time_us + after_us);
        bool under_way = tmc22xx_busy();
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_close(BENCH_WIRE));
        TEST_ASSERT_FALSE(tmc22xx_busy());
        TEST_ASSERT_NULL(pins_owner(BENCH_WIRE));
        TEST_ASSERT_EQUAL(under_way ? ERR_TMC_CLOSED : ERR_OK, tmc22xx_result());
        unsigned driver;
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_find(0, PINS_NONE, &driver));
        bench_succeeds(tmc22xx_set_current(driver, 500, -1));
        bench_set_up(BENCH_WIRE, 0);
    }
}

// ---- Homing -------------------------------------------------------------------------------------

static void test_arming(void) {
    line_chip_t *x = line_add(BENCH_WIRE, 0);
    line_chip_t *y = line_add(BENCH_WIRE, 1);
    line_chip_t *z = line_add(BENCH_WIRE, 2);
    unsigned drivers[] = {bench_set_up(BENCH_WIRE, 0), bench_set_up(BENCH_WIRE, 1),
                          bench_set_up(BENCH_WIRE, 2)};
    bench_succeeds(tmc22xx_begin_write(drivers[0], TMC22XX_REG_SGTHRS, 50));
    tmc22xx_keep_threshold(drivers[0], 300, true);
    tmc22xx_keep_threshold(drivers[0], 77, false); // the user's stays
    bench_succeeds(tmc22xx_begin_write(drivers[1], TMC22XX_REG_TCOOLTHRS, 200));
    tmc22xx_keep_threshold(drivers[1], 77, false);
    tmc22xx_keep_threshold(drivers[2], 88, false);
    uint32_t all = 1u << drivers[0] | 1u << drivers[1] | 1u << drivers[2];
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(all, true));
    TEST_ASSERT_TRUE(tmc22xx_arm_busy());
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_UINT32(300, x->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(200, y->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(88, z->registers[TMC22XX_REG_TCOOLTHRS]);
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(drivers[0], &info));
    TEST_ASSERT_TRUE(info.armed);
    TEST_ASSERT_EQUAL_UINT32(0, info.tcoolthrs);
    TEST_ASSERT_EQUAL_UINT32(300, info.kept_tcoolthrs);
    bench_succeeds(tmc22xx_begin_write(drivers[2], TMC22XX_REG_TCOOLTHRS, 44)); // for later
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(all, false));
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_UINT32(0, x->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(200, y->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(44, z->registers[TMC22XX_REG_TCOOLTHRS]);
}

static void test_arming_fails_at_the_first_and_disarming_goes_on(void) {
    line_chip_t *x = line_add(BENCH_WIRE, 0);
    line_chip_t *y = line_add(BENCH_WIRE, 1);
    unsigned drivers[] = {bench_set_up(BENCH_WIRE, 0), bench_set_up(BENCH_WIRE, 1)};
    tmc22xx_keep_threshold(drivers[0], 300, true);
    tmc22xx_keep_threshold(drivers[1], 300, true);
    x->gone = true;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(3, true));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_UINT32(0, y->registers[TMC22XX_REG_TCOOLTHRS]);
    y->registers[TMC22XX_REG_TCOOLTHRS] = 300;
    bench_succeeds(tmc22xx_begin_write(drivers[1], TMC22XX_REG_SGTHRS, 9));
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_arm_result()); // not a statement's
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(3, false));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_STRING("No answer from address 0 on GP16 (pin 21): check motor supply and "
                             "wire",
                             err_message());
    TEST_ASSERT_EQUAL_UINT32(0, y->registers[TMC22XX_REG_TCOOLTHRS]);
}

static void test_blind_arming_tells_the_threshold_of_a_stall_again(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    tmc22xx_verify(false);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 50));
    tmc22xx_keep_threshold(driver, 300, true);
    line_power_up(chip);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(1u << driver, true));
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_UINT32(300, chip->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(50, chip->registers[TMC22XX_REG_SGTHRS]);
}

// ---- Giving up ----------------------------------------------------------------------------------

static void test_giving_up_puts_back_what_was_written(void) {
    for (uint64_t after_us = 0; after_us < 15000; after_us += 97) {
        line_reset();
        line_chip_t *chip = line_add(BENCH_WIRE, 0);
        unsigned driver = bench_set_up(BENCH_WIRE, 0);
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_current(driver, 1000, -1));
        line_run_until(line.time_us + after_us);
        bool under_way = tmc22xx_busy();
        tmc22xx_give_up();
        line_run();
        TEST_ASSERT_EQUAL(under_way ? ERR_TMC_GIVEN_UP : ERR_OK, tmc22xx_result());
        TEST_ASSERT_EQUAL_DOUBLE(under_way ? 800 : 1000, tmc22xx_driver(driver)->run_ma);
        TEST_ASSERT_EQUAL_HEX32(under_way ? 0x00081907 : 0x00081105,
                                chip->registers[TMC22XX_REG_IHOLD_IRUN]);
        TEST_ASSERT_EQUAL_HEX32(under_way ? 0x14030153 : 0x14010153,
                                chip->registers[TMC22XX_REG_CHOPCONF]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_changes_start_from_what_was_written);
    RUN_TEST(test_the_current_is_never_above_both);
    RUN_TEST(test_reading);
    RUN_TEST(test_reading_a_driver_that_was_reset);
    RUN_TEST(test_what_cannot_be_asked_for);
    RUN_TEST(test_one_job_at_a_time);
    RUN_TEST(test_two_wires_and_two_addresses);
    RUN_TEST(test_no_answer_at_a_pin_of_its_own);
    RUN_TEST(test_a_wire_with_two_pins);
    RUN_TEST(test_the_counters_of_a_driver);
    RUN_TEST(test_no_more_than_eight);
    RUN_TEST(test_a_wire_that_closes_under_a_job);
    RUN_TEST(test_arming);
    RUN_TEST(test_arming_fails_at_the_first_and_disarming_goes_on);
    RUN_TEST(test_blind_arming_tells_the_threshold_of_a_stall_again);
    RUN_TEST(test_giving_up_puts_back_what_was_written);
    return UNITY_END();
}
