// Setting drivers up on a wire in memory: what is sent, when, and what is told if it cannot be.
#include "bench.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "hal/hal.h"
#include "tmc22xx/tmc22xx_registers.h"

void setUp(void) {
    line_reset();
}
void tearDown(void) {}

// ---- Set-up -------------------------------------------------------------------------------------

static void expect_frame(size_t index, const char *hex) {
    char text[32] = "";
    for (size_t i = 0; i < line.frames[index].size; i++) {
        sprintf(text + strlen(text), i == 0 ? "%02X" : " %02X", line.frames[index].bytes[i]);
    }
    TEST_ASSERT_EQUAL_STRING(hex, text);
}

static void test_blind_is_five_frames_and_nothing_else(void) {
    tmc22xx_verify(false);
    line_expect(NULL);
    bench_succeeds(tmc22xx_set_up(&bench_usual)); // there is no chip
    TEST_ASSERT_EQUAL_UINT(5, line.frame_count);
    expect_frame(0, "05 00 80 00 00 01 C0 F6");
    expect_frame(1, "05 00 90 00 08 19 07 15");
    expect_frame(2, "05 00 91 00 00 00 14 1F");
    expect_frame(3, "05 00 EC 14 03 01 53 69");
    expect_frame(4, "05 00 F0 CF 0D 0E 24 96");
    for (size_t i = 1; i < 5; i++) { // 80 bits, and the pause
        TEST_ASSERT_EQUAL_UINT64(694 + 200, line.frames[i].time_us - line.frames[i - 1].time_us);
    }
}

static void test_blind_again_is_five_frames(void) {
    tmc22xx_verify(false);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 120));
    line_expect(NULL);
    bench_set_up(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL_UINT(5, line.frame_count);
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT8(120, info.sgthrs);
}

static void test_a_driver_that_was_just_switched_on(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    line_expect(NULL);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL_STRING("R06 R01 R02 W01 00000001 R02 W03 00000200 R02 W00 000001C0 R02 "
                             "W10 00081907 R02 W11 00000014 R02 W6C 14030153 R02 "
                             "W70 CF0D0E24 R02 R01 ",
                             bench_sent());
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_GSTAT]);
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_TRUE(info.listens);
    TEST_ASSERT_EQUAL_UINT8(7, info.ifcnt);
    TEST_ASSERT_EQUAL_UINT16(0, info.repeats);
    TEST_ASSERT_EQUAL_UINT8(TMC22XX_NO_AXIS, info.axis);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 795, info.run_ma);
}

static void test_how_long_a_set_up_takes(void) {
    line_add(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&bench_usual));
    uint64_t verified_us = line_run();
    tmc22xx_verify(false);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&bench_usual));
    uint64_t blind_us = line_run();
    printf("A set-up at 115200 baud: verified %u us, blind %u us\n", (unsigned)verified_us,
           (unsigned)blind_us);
    TEST_ASSERT_LESS_THAN_UINT64(25000, verified_us);
    TEST_ASSERT_LESS_THAN_UINT64(4500, blind_us);
}

// Something else than after power-up stands in registers that a set-up does not write.
static void test_a_driver_from_an_earlier_life(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    chip->registers[TMC22XX_REG_GSTAT] = 0;
    chip->registers[TMC22XX_REG_TCOOLTHRS] = 200;
    chip->registers[TMC22XX_REG_SGTHRS] = 99;
    chip->registers[TMC22XX_REG_COOLCONF] = 5;
    chip->registers[TMC22XX_REG_TPWMTHRS] = 7;
    bench_set_up(BENCH_WIRE, 0);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_SGTHRS]);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_COOLCONF]);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_TPWMTHRS]);
}

static void test_after_a_power_cut_a_set_up_restores_everything(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 120));
    const tmc22xx_coolstep_t coolstep = {.semin = 5, .semax = 2};
    bench_succeeds(tmc22xx_set_coolstep(driver, &coolstep));
    line_power_up(chip);
    bench_fails(tmc22xx_set_current(driver, 500, -1),
                "The driver has lost its settings (was its power off?), set it up again: "
                "address 0 on GP16 (pin 21)");
    TEST_ASSERT_EQUAL_DOUBLE(800, tmc22xx_driver(driver)->run_ma);
    TEST_ASSERT_EQUAL_UINT(driver, bench_set_up(BENCH_WIRE, 0));
    TEST_ASSERT_EQUAL_HEX32(120, chip->registers[TMC22XX_REG_SGTHRS]);
    TEST_ASSERT_EQUAL_HEX32(0x205, chip->registers[TMC22XX_REG_COOLCONF]);
    TEST_ASSERT_EQUAL_HEX32(0x00081907, chip->registers[TMC22XX_REG_IHOLD_IRUN]);
    bench_succeeds(tmc22xx_set_current(driver, 500, -1));
}

static void test_a_2208(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    chip->is_2208 = true;
    line_power_up(chip);
    chip->registers[TMC22XX_REG_GSTAT] = 0;
    tmc22xx_settings_t settings = bench_usual;
    settings.chip = 2208;
    line_expect(NULL);
    bench_succeeds(tmc22xx_set_up(&settings));
    TEST_ASSERT_NULL(strstr(bench_sent(), "W40")); // it has no SGTHRS
    TEST_ASSERT_NOT_NULL(strstr(bench_sent(), "W13"));
    bench_refused(tmc22xx_begin_write(0, TMC22XX_REG_SGTHRS, 1), "A TMC2208 has no SGTHRS");
    const uint8_t sg_result = TMC22XX_REG_SG_RESULT;
    bench_refused(tmc22xx_begin_read(0, &sg_result, 1), "A TMC2208 has no SG_RESULT");
}

static void test_the_wrong_chip(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    chip->is_2208 = true;
    line_power_up(chip);
    bench_fails(tmc22xx_set_up(&bench_usual),
                "The driver is a TMC2208, not a TMC2209: address 0 on GP16 (pin 21)");
    TEST_ASSERT_NULL(tmc22xx_driver(0));
    TEST_ASSERT_FALSE(line_is_open(BENCH_WIRE));
    TEST_ASSERT_NULL(pins_owner(BENCH_WIRE));
    chip->registers[TMC22XX_REG_IOIN] = 0x30000000;
    bench_fails(tmc22xx_set_up(&bench_usual),
                "The driver is no TMC2209: address 0 on GP16 (pin 21) (its version is 0x30)");
}

// ---- Who answers --------------------------------------------------------------------------------

static void test_nobody_answers(void) {
    line_expect(NULL);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&bench_usual));
    uint64_t time_us = line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_result());
    TEST_ASSERT_EQUAL_STRING("No answer from address 0 on GP16 (pin 21): check motor supply, wire "
                             "to PDN_UART, 1 k resistor (without a way back: TMC22xx VERIFY 0)",
                             err_message());
    TEST_ASSERT_EQUAL_UINT(6, line.frame_count);
    TEST_ASSERT_LESS_THAN_UINT64(150000, time_us);
    TEST_ASSERT_NULL(pins_owner(BENCH_WIRE));
}

static void test_another_address_answers(void) {
    line_add(BENCH_WIRE, 2);
    bench_fails(tmc22xx_set_up(&bench_usual),
                "No answer from address 0 on GP16 (pin 21); a driver answers at "
                "address 2: check MS1 and MS2, or the address");
}

static void test_a_known_driver_answers(void) {
    line_add(BENCH_WIRE, 1);
    bench_set_up(BENCH_WIRE, 1);
    tmc22xx_settings_t settings = bench_settings(BENCH_WIRE, 0);
    bench_fails(tmc22xx_set_up(&settings),
                "No answer from address 0 on GP16 (pin 21); others on this "
                "wire answer: check its motor supply, MS1 and MS2");
    TEST_ASSERT_TRUE(line_is_open(BENCH_WIRE)); // the other one still needs it
    line_add(BENCH_WIRE, 3);
    bench_fails(tmc22xx_set_up(&settings),
                "No answer from address 0 on GP16 (pin 21); a driver answers "
                "at address 3: check MS1 and MS2, or the address");
}

// Whoever clears the flag of a reset takes the settings as they are.
static void test_a_reset_that_the_user_has_mended(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    line_power_up(chip);
    TEST_ASSERT_EQUAL(ERR_TMC_LOST, bench_end(tmc22xx_set_current(driver, 500, -1)));
    TEST_ASSERT_EQUAL(ERR_TMC_LOST, bench_end(tmc22xx_set_current(driver, 500, -1)));
    bench_succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_GSTAT, 1));
    bench_succeeds(tmc22xx_set_current(driver, 500, -1));
}

static line_fault_t held_low(size_t frame) {
    (void)frame;
    return LINE_HELD_LOW;
}

static void test_a_line_that_is_held_low(void) {
    line_add(BENCH_WIRE, 0);
    line_expect(held_low);
    bench_fails(tmc22xx_set_up(&bench_usual),
                "The line GP16 (pin 21) is held low: is the driver powered?");
    TEST_ASSERT_EQUAL_UINT(3, line.frame_count);
}

static line_fault_t noise(size_t frame) {
    (void)frame;
    return LINE_NOISE;
}

static void test_garbled_answers(void) {
    line_add(BENCH_WIRE, 0);
    line_expect(noise);
    bench_fails(tmc22xx_set_up(&bench_usual),
                "No clear answer from address 0 on GP16 (pin 21): check ground, "
                "1 k resistor, two drivers with one address");
}

static void test_a_deaf_driver(void) {
    line_chip_t *chip = line_add(BENCH_WIRE, 0);
    unsigned driver = bench_set_up(BENCH_WIRE, 0);
    tmc22xx_tie(driver, 2);
    chip->deaf = true;
    bench_fails(tmc22xx_set_current(driver, 500, -1),
                "The driver answers, but takes no settings: address 0 on GP16 (pin 21), axis Z");
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT16(1, info.failures);
    TEST_ASSERT_EQUAL_DOUBLE(800, tmc22xx_driver(driver)->run_ma);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_blind_is_five_frames_and_nothing_else);
    RUN_TEST(test_blind_again_is_five_frames);
    RUN_TEST(test_a_driver_that_was_just_switched_on);
    RUN_TEST(test_how_long_a_set_up_takes);
    RUN_TEST(test_a_driver_from_an_earlier_life);
    RUN_TEST(test_after_a_power_cut_a_set_up_restores_everything);
    RUN_TEST(test_a_2208);
    RUN_TEST(test_the_wrong_chip);
    RUN_TEST(test_nobody_answers);
    RUN_TEST(test_another_address_answers);
    RUN_TEST(test_a_known_driver_answers);
    RUN_TEST(test_a_reset_that_the_user_has_mended);
    RUN_TEST(test_a_line_that_is_held_low);
    RUN_TEST(test_garbled_answers);
    RUN_TEST(test_a_deaf_driver);
    return UNITY_END();
}
