// Jobs on a wire in memory: what is sent, when, and what is known afterwards.
#include "tmc22xx/tmc22xx.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "hal/hal.h"
#include "line.h"
#include "tmc22xx/tmc22xx_registers.h"

#define WIRE 16
#define OTHER_WIRE 5

static const tmc22xx_settings_t usual = {.tx_gpio = WIRE,
                                         .address = 0,
                                         .chip = 2209,
                                         .run_ma = 800,
                                         .hold_percent = 30,
                                         .microsteps = 16,
                                         .r_sense_ohm = 0.11,
                                         .stealth = true};
static char words[40 * LINE_FRAMES];

void setUp(void) {
    line_reset();
}
void tearDown(void) {}

static err_t end(err_t begun) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", begun == ERR_OK ? "" : err_message(), "at once");
    line_run();
    return tmc22xx_result();
}

static void succeeds(err_t begun) {
    err_t err = end(begun);
    TEST_ASSERT_EQUAL_STRING("", err == ERR_OK ? "" : err_message());
}

static void fails(err_t begun, const char *message) {
    TEST_ASSERT_NOT_EQUAL(ERR_OK, end(begun));
    TEST_ASSERT_EQUAL_STRING(message, err_message());
}

static void refused(err_t begun, const char *message) {
    TEST_ASSERT_NOT_EQUAL(ERR_OK, begun);
    TEST_ASSERT_EQUAL_STRING(message, err_message());
    TEST_ASSERT_FALSE(tmc22xx_busy());
}

static tmc22xx_settings_t at(uint8_t tx_gpio, uint8_t address) {
    tmc22xx_settings_t settings = usual;
    settings.tx_gpio = tx_gpio;
    settings.address = address;
    return settings;
}

static unsigned set_up(uint8_t tx_gpio, uint8_t address) {
    tmc22xx_settings_t settings = at(tx_gpio, address);
    succeeds(tmc22xx_set_up(&settings));
    unsigned driver = 99;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_find(address, tx_gpio, &driver));
    return driver;
}

// "W 00 000001C0", "R 02" ...: what was sent, in order.
static const char *sent(void) {
    size_t length = 0;
    words[0] = 0;
    for (size_t i = 0; i < line.frame_count && i < LINE_FRAMES; i++) {
        const uint8_t *bytes = line.frames[i].bytes;
        if (line.frames[i].size == 8) {
            length += (size_t)sprintf(words + length, "W%02X %02X%02X%02X%02X ", bytes[2] & 0x7F,
                                      bytes[3], bytes[4], bytes[5], bytes[6]);
        } else {
            length += (size_t)sprintf(words + length, "R%02X ", bytes[2]);
        }
    }
    return words;
}

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
    succeeds(tmc22xx_set_up(&usual)); // there is no chip
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
    unsigned driver = set_up(WIRE, 0);
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 120));
    line_expect(NULL);
    set_up(WIRE, 0);
    TEST_ASSERT_EQUAL_UINT(5, line.frame_count);
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT8(120, info.sgthrs);
}

static void test_a_driver_that_was_just_switched_on(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    line_expect(NULL);
    unsigned driver = set_up(WIRE, 0);
    TEST_ASSERT_EQUAL_STRING("R06 R01 R02 W01 00000001 R02 W03 00000200 R02 W00 000001C0 R02 "
                             "W10 00081907 R02 W11 00000014 R02 W6C 14030153 R02 "
                             "W70 CF0D0E24 R02 R01 ",
                             sent());
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
    line_add(WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&usual));
    uint64_t verified_us = line_run();
    tmc22xx_verify(false);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&usual));
    uint64_t blind_us = line_run();
    printf("A set-up at 115200 baud: verified %u us, blind %u us\n", (unsigned)verified_us,
           (unsigned)blind_us);
    TEST_ASSERT_LESS_THAN_UINT64(25000, verified_us);
    TEST_ASSERT_LESS_THAN_UINT64(4500, blind_us);
}

// Something else than after power-up stands in registers that a set-up does not write.
static void test_a_driver_from_an_earlier_life(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    chip->registers[TMC22XX_REG_GSTAT] = 0;
    chip->registers[TMC22XX_REG_TCOOLTHRS] = 200;
    chip->registers[TMC22XX_REG_SGTHRS] = 99;
    chip->registers[TMC22XX_REG_COOLCONF] = 5;
    chip->registers[TMC22XX_REG_TPWMTHRS] = 7;
    set_up(WIRE, 0);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_SGTHRS]);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_COOLCONF]);
    TEST_ASSERT_EQUAL_HEX32(0, chip->registers[TMC22XX_REG_TPWMTHRS]);
}

static void test_after_a_power_cut_a_set_up_restores_everything(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 120));
    const tmc22xx_coolstep_t coolstep = {.semin = 5, .semax = 2};
    succeeds(tmc22xx_set_coolstep(driver, &coolstep));
    line_power_up(chip);
    fails(tmc22xx_set_current(driver, 500, -1),
          "The driver has lost its settings (was its power off?), set it up again: "
          "address 0 on GP16 (pin 21)");
    TEST_ASSERT_EQUAL_DOUBLE(800, tmc22xx_driver(driver)->run_ma);
    TEST_ASSERT_EQUAL_UINT(driver, set_up(WIRE, 0));
    TEST_ASSERT_EQUAL_HEX32(120, chip->registers[TMC22XX_REG_SGTHRS]);
    TEST_ASSERT_EQUAL_HEX32(0x205, chip->registers[TMC22XX_REG_COOLCONF]);
    TEST_ASSERT_EQUAL_HEX32(0x00081907, chip->registers[TMC22XX_REG_IHOLD_IRUN]);
    succeeds(tmc22xx_set_current(driver, 500, -1));
}

static void test_a_2208(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    chip->is_2208 = true;
    line_power_up(chip);
    chip->registers[TMC22XX_REG_GSTAT] = 0;
    tmc22xx_settings_t settings = usual;
    settings.chip = 2208;
    line_expect(NULL);
    succeeds(tmc22xx_set_up(&settings));
    TEST_ASSERT_NULL(strstr(sent(), "W40")); // it has no SGTHRS
    TEST_ASSERT_NOT_NULL(strstr(sent(), "W13"));
    refused(tmc22xx_begin_write(0, TMC22XX_REG_SGTHRS, 1), "A TMC2208 has no SGTHRS");
    const uint8_t sg_result = TMC22XX_REG_SG_RESULT;
    refused(tmc22xx_begin_read(0, &sg_result, 1), "A TMC2208 has no SG_RESULT");
}

static void test_the_wrong_chip(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    chip->is_2208 = true;
    line_power_up(chip);
    fails(tmc22xx_set_up(&usual),
          "The driver is a TMC2208, not a TMC2209: address 0 on GP16 (pin 21)");
    TEST_ASSERT_NULL(tmc22xx_driver(0));
    TEST_ASSERT_FALSE(line_is_open(WIRE));
    TEST_ASSERT_NULL(pins_owner(WIRE));
    chip->registers[TMC22XX_REG_IOIN] = 0x30000000;
    fails(tmc22xx_set_up(&usual),
          "The driver is no TMC2209: address 0 on GP16 (pin 21) (its version is 0x30)");
}

// ---- Who answers --------------------------------------------------------------------------------

static void test_nobody_answers(void) {
    line_expect(NULL);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&usual));
    uint64_t time_us = line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_result());
    TEST_ASSERT_EQUAL_STRING("No answer from address 0 on GP16 (pin 21): check motor supply, wire "
                             "to PDN_UART, 1 k resistor (without a way back: TMC22xx VERIFY 0)",
                             err_message());
    TEST_ASSERT_EQUAL_UINT(6, line.frame_count);
    TEST_ASSERT_LESS_THAN_UINT64(150000, time_us);
    TEST_ASSERT_NULL(pins_owner(WIRE));
}

static void test_another_address_answers(void) {
    line_add(WIRE, 2);
    fails(tmc22xx_set_up(&usual), "No answer from address 0 on GP16 (pin 21); a driver answers at "
                                  "address 2: check MS1 and MS2, or the address");
}

static void test_a_known_driver_answers(void) {
    line_add(WIRE, 1);
    set_up(WIRE, 1);
    tmc22xx_settings_t settings = at(WIRE, 0);
    fails(tmc22xx_set_up(&settings), "No answer from address 0 on GP16 (pin 21); others on this "
                                     "wire answer: check its motor supply, MS1 and MS2");
    TEST_ASSERT_TRUE(line_is_open(WIRE)); // the other one still needs it
    line_add(WIRE, 3);
    fails(tmc22xx_set_up(&settings), "No answer from address 0 on GP16 (pin 21); a driver answers "
                                     "at address 3: check MS1 and MS2, or the address");
}

// Whoever clears the flag of a reset takes the settings as they are.
static void test_a_reset_that_the_user_has_mended(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    line_power_up(chip);
    TEST_ASSERT_EQUAL(ERR_TMC_LOST, end(tmc22xx_set_current(driver, 500, -1)));
    TEST_ASSERT_EQUAL(ERR_TMC_LOST, end(tmc22xx_set_current(driver, 500, -1)));
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_GSTAT, 1));
    succeeds(tmc22xx_set_current(driver, 500, -1));
}

static line_fault_t held_low(size_t frame) {
    (void)frame;
    return LINE_HELD_LOW;
}

static void test_a_line_that_is_held_low(void) {
    line_add(WIRE, 0);
    line_expect(held_low);
    fails(tmc22xx_set_up(&usual), "The line GP16 (pin 21) is held low: is the driver powered?");
    TEST_ASSERT_EQUAL_UINT(3, line.frame_count);
}

static line_fault_t noise(size_t frame) {
    (void)frame;
    return LINE_NOISE;
}

static void test_garbled_answers(void) {
    line_add(WIRE, 0);
    line_expect(noise);
    fails(tmc22xx_set_up(&usual), "No clear answer from address 0 on GP16 (pin 21): check ground, "
                                  "1 k resistor, two drivers with one address");
}

static void test_a_deaf_driver(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    tmc22xx_tie(driver, 2);
    chip->deaf = true;
    fails(tmc22xx_set_current(driver, 500, -1),
          "The driver answers, but takes no settings: address 0 on GP16 (pin 21), axis Z");
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT16(1, info.failures);
    TEST_ASSERT_EQUAL_DOUBLE(800, tmc22xx_driver(driver)->run_ma);
}

// ---- Changes ------------------------------------------------------------------------------------

static void test_changes_start_from_what_was_written(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_CHOPCONF, 0x14030155)); // TOFF 5
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_IHOLD_IRUN, 0x00031008));
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 520, tmc22xx_driver(driver)->run_ma);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 50, tmc22xx_driver(driver)->hold_percent);
    succeeds(tmc22xx_set_current(driver, 1000, -1));
    TEST_ASSERT_EQUAL_HEX32(0x14010155, chip->registers[TMC22XX_REG_CHOPCONF]);
    TEST_ASSERT_EQUAL_HEX32(0x00031108, chip->registers[TMC22XX_REG_IHOLD_IRUN]);
    succeeds(tmc22xx_set_stealth(driver, false, 0));
    TEST_ASSERT_EQUAL_HEX32(0x1C4, chip->registers[TMC22XX_REG_GCONF]);
    TEST_ASSERT_FALSE(tmc22xx_driver(driver)->stealth);
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_GCONF, 0x1C8)); // turned round
    succeeds(tmc22xx_set_stealth(driver, false, 100));
    TEST_ASSERT_EQUAL_HEX32(0x1CC, chip->registers[TMC22XX_REG_GCONF]);
    TEST_ASSERT_EQUAL_HEX32(100, chip->registers[TMC22XX_REG_TPWMTHRS]);
}

// From 1000 to 900 mA the scale rises from 17 to 28 in the finer range.
static void test_the_current_is_never_above_both(void) {
    line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    succeeds(tmc22xx_set_current(driver, 1000, 100));
    line_expect(NULL);
    succeeds(tmc22xx_set_current(driver, 900, 100));
    TEST_ASSERT_EQUAL_STRING("R02 W6C 14030153 R02 W10 00081C1C R02 R01 ", sent());
    line_expect(NULL);
    succeeds(tmc22xx_set_current(driver, 1000, 100));
    TEST_ASSERT_EQUAL_STRING("R02 W10 00081111 R02 W6C 14010153 R02 R01 ", sent());
}

static void test_reading(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    chip->registers[TMC22XX_REG_SG_RESULT] = 0x12C;
    chip->registers[TMC22XX_REG_DRV_STATUS] = 0xC0190000;
    const uint8_t registers[] = {TMC22XX_REG_SG_RESULT, TMC22XX_REG_DRV_STATUS};
    succeeds(tmc22xx_begin_read(driver, registers, 2));
    TEST_ASSERT_EQUAL_HEX32(0x12C, tmc22xx_value(0));
    TEST_ASSERT_EQUAL_HEX32(0xC0190000, tmc22xx_value(1));
    TEST_ASSERT_EQUAL_HEX32(0, tmc22xx_value(2));
}

// The user still gets what was read, and is told beside it.
static void test_reading_a_driver_that_was_reset(void) {
    line_chip_t *chip = line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    line_power_up(chip);
    const uint8_t reg = TMC22XX_REG_GCONF;
    succeeds(tmc22xx_begin_read(driver, &reg, 1));
    TEST_ASSERT_EQUAL_HEX32(0x101, tmc22xx_value(0));
    char text[160];
    TEST_ASSERT_TRUE(tmc22xx_next_event(text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("TMC2209 at address 0 on GP16 (pin 21) has lost its settings (was its "
                             "power off?): set it up again",
                             text);
    TEST_ASSERT_FALSE(tmc22xx_next_event(text, sizeof text));
}

static void test_what_cannot_be_asked_for(void) {
    line_add(WIRE, 0);
    refused(tmc22xx_begin_write(0, TMC22XX_REG_GCONF, 0),
            "TMC22xx not initialized (no such driver)");
    unsigned driver = set_up(WIRE, 0);
    refused(tmc22xx_begin_write(driver, TMC22XX_REG_IFCNT, 0), "IFCNT can only be read");
    refused(tmc22xx_begin_write(driver, TMC22XX_REG_OTP_PROG, 0xBD00),
            "OTP_PROG cannot be undone and is not written");
    refused(tmc22xx_begin_write(driver, 0x7E, 0), "There is no register 0x7E");
    refused(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 256), "SGTHRS takes values up to 0xFF");
    refused(tmc22xx_begin_write(driver, TMC22XX_REG_VACTUAL, 0xFF7FFFFF),
            "VACTUAL takes values up to 0xFFFFFF");
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_VACTUAL, (uint32_t)-0x800000));
    TEST_ASSERT_EQUAL_HEX32(0x800000, line.chips[0].registers[TMC22XX_REG_VACTUAL]);
    const uint8_t registers[] = {TMC22XX_REG_SGTHRS};
    refused(tmc22xx_begin_read(driver, registers, 1), "SGTHRS can only be written");
    refused(tmc22xx_set_current(driver, 0, 0),
            "Motor current 0 mA is too little (the least is 30.6 mA)");
}

static void test_one_job_at_a_time(void) {
    line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_current(driver, 500, -1));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_set_current(driver, 600, -1));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_set_up(&usual));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_wire(OTHER_WIRE, OTHER_WIRE, 9600));
    TEST_ASSERT_EQUAL(ERR_TMC_BUSY, tmc22xx_begin_arm(1, true));
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_result());
    TEST_ASSERT_EQUAL_DOUBLE(500, tmc22xx_driver(driver)->run_ma);
}

// ---- Wires --------------------------------------------------------------------------------------

static void test_two_wires_and_two_addresses(void) {
    line_add(WIRE, 0);
    line_add(WIRE, 1);
    line_add(OTHER_WIRE, 0);
    set_up(WIRE, 0);
    unsigned second = set_up(WIRE, 1);
    unsigned third = set_up(OTHER_WIRE, 0);
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
    refused(tmc22xx_find(3, PINS_NONE, &driver),
            "TMC22xx not initialized (no driver at address 3)");
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_close(WIRE));
    TEST_ASSERT_NULL(pins_owner(WIRE));
    TEST_ASSERT_NULL(tmc22xx_driver(second));
    TEST_ASSERT_NOT_NULL(tmc22xx_driver(third));
    refused(tmc22xx_close(WIRE), "TMC22xx not initialized (no wire on this pin)");
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_close(PINS_NONE));
    refused(tmc22xx_close(PINS_NONE), "TMC22xx not initialized (no wire)");
}

static void test_a_wire_with_two_pins(void) {
    line_add(WIRE, 0);
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_wire(WIRE, 17, 9600));
    unsigned driver = set_up(WIRE, 0);
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT8(17, info.rx_gpio);
    TEST_ASSERT_EQUAL_UINT32(9600, info.baud);
    TEST_ASSERT_EQUAL_STRING("TMC22xx wire", pins_owner(17));
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_wire(WIRE, WIRE, 115200)); // the driver stays
    TEST_ASSERT_NULL(pins_owner(17));
    TEST_ASSERT_EQUAL_STRING("TMC22xx wire", pins_owner(WIRE));
    succeeds(tmc22xx_set_current(driver, 500, -1));
    pins_claim(18, "somebody");
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, tmc22xx_wire(WIRE, 18, 115200));
    succeeds(tmc22xx_set_current(driver, 600, -1));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, tmc22xx_wire(20, 18, 115200));
    TEST_ASSERT_NULL(pins_owner(20));
    pins_disclaim(18);
    TEST_ASSERT_EQUAL(ERR_ARGUMENT, tmc22xx_wire(WIRE, WIRE, 9599));
}

// What goes wrong with one driver does not count for another.
static void test_the_counters_of_a_driver(void) {
    line_add(WIRE, 0);
    unsigned driver = set_up(WIRE, 0);
    tmc22xx_settings_t other = at(WIRE, 3); // there is none
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&other));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_result());
    other = at(WIRE, 0);
    other.chip = 2208;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&other));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_WRONG_CHIP, tmc22xx_result());
    succeeds(tmc22xx_set_current(driver, 500, -1));
    tmc22xx_info_t info;
    TEST_ASSERT_TRUE(tmc22xx_info(driver, &info));
    TEST_ASSERT_EQUAL_UINT16(0, info.repeats);
    TEST_ASSERT_EQUAL_UINT16(0, info.failures);
}

static void test_no_more_than_eight(void) {
    for (uint8_t i = 0; i < 8; i++) {
        line_add((uint8_t)(10 + i / 4), i % 4);
        set_up((uint8_t)(10 + i / 4), i % 4);
    }
    tmc22xx_settings_t settings = at(20, 0);
    refused(tmc22xx_set_up(&settings), "Too many TMC22xx drivers (at most 8)");
    TEST_ASSERT_NULL(pins_owner(20));
    set_up(10, 3); // again is fine
}

// Wherever the wire closes, nothing is left of the job.
static void test_a_wire_that_closes_under_a_job(void) {
    for (uint64_t after_us = 0; after_us < 24000; after_us += 173) {
        line_reset();
        line_add(WIRE, 0);
        line_add(OTHER_WIRE, 0);
        set_up(OTHER_WIRE, 0);
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_set_up(&usual));
        line_run_until(line.time_us + after_us);
        bool under_way = tmc22xx_busy();
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_close(WIRE));
        TEST_ASSERT_FALSE(tmc22xx_busy());
        TEST_ASSERT_NULL(pins_owner(WIRE));
        TEST_ASSERT_EQUAL(under_way ? ERR_TMC_CLOSED : ERR_OK, tmc22xx_result());
        unsigned driver;
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_find(0, PINS_NONE, &driver));
        succeeds(tmc22xx_set_current(driver, 500, -1));
        set_up(WIRE, 0);
    }
}

// ---- Homing -------------------------------------------------------------------------------------

static void test_arming(void) {
    line_chip_t *x = line_add(WIRE, 0);
    line_chip_t *y = line_add(WIRE, 1);
    line_chip_t *z = line_add(WIRE, 2);
    unsigned drivers[] = {set_up(WIRE, 0), set_up(WIRE, 1), set_up(WIRE, 2)};
    succeeds(tmc22xx_begin_write(drivers[0], TMC22XX_REG_SGTHRS, 50));
    tmc22xx_keep_threshold(drivers[0], 300, true);
    tmc22xx_keep_threshold(drivers[0], 77, false); // the user's stays
    succeeds(tmc22xx_begin_write(drivers[1], TMC22XX_REG_TCOOLTHRS, 200));
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
    succeeds(tmc22xx_begin_write(drivers[2], TMC22XX_REG_TCOOLTHRS, 44)); // for later
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(all, false));
    line_run();
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_UINT32(0, x->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(200, y->registers[TMC22XX_REG_TCOOLTHRS]);
    TEST_ASSERT_EQUAL_UINT32(44, z->registers[TMC22XX_REG_TCOOLTHRS]);
}

static void test_arming_fails_at_the_first_and_disarming_goes_on(void) {
    line_chip_t *x = line_add(WIRE, 0);
    line_chip_t *y = line_add(WIRE, 1);
    unsigned drivers[] = {set_up(WIRE, 0), set_up(WIRE, 1)};
    tmc22xx_keep_threshold(drivers[0], 300, true);
    tmc22xx_keep_threshold(drivers[1], 300, true);
    x->gone = true;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_begin_arm(3, true));
    line_run();
    TEST_ASSERT_EQUAL(ERR_TMC_SILENT, tmc22xx_arm_result());
    TEST_ASSERT_EQUAL_UINT32(0, y->registers[TMC22XX_REG_TCOOLTHRS]);
    y->registers[TMC22XX_REG_TCOOLTHRS] = 300;
    succeeds(tmc22xx_begin_write(drivers[1], TMC22XX_REG_SGTHRS, 9));
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
    line_chip_t *chip = line_add(WIRE, 0);
    tmc22xx_verify(false);
    unsigned driver = set_up(WIRE, 0);
    succeeds(tmc22xx_begin_write(driver, TMC22XX_REG_SGTHRS, 50));
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
        line_chip_t *chip = line_add(WIRE, 0);
        unsigned driver = set_up(WIRE, 0);
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
    RUN_TEST(test_changes_start_from_what_was_written);
    RUN_TEST(test_the_current_is_never_above_both);
    RUN_TEST(test_reading);
    RUN_TEST(test_reading_a_driver_that_was_reset);
    RUN_TEST(test_what_cannot_be_asked_for);
    RUN_TEST(test_one_job_at_a_time);
    RUN_TEST(test_two_wires_and_two_addresses);
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
