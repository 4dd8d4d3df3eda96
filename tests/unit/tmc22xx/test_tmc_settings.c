// Settings to registers: the set-ups captured from the PicoMite firmware, currents over the whole
// range, speeds there and back, and what is refused.
#include "tmc22xx/settings.h"

#include <math.h>
#include <string.h>
#include <unity.h>

#include "tmc22xx/tmc22xx_registers.h"

void setUp(void) {}
void tearDown(void) {}

static tmc22xx_settings_t plain(void) {
    return (tmc22xx_settings_t){.tx_gpio = 16,
                                .chip = 2209,
                                .run_ma = 800,
                                .hold_percent = 30,
                                .microsteps = 16,
                                .r_sense_ohm = 0.11,
                                .stealth = true};
}

// ---- Set-ups ------------------------------------------------------------------------------------

static const struct {
    tmc22xx_settings_t settings;
    uint32_t values[TMC22XX_SETUP_WRITES];
} golden[] = {
    {{16, 0, 2209, 800, 30, 16, 0.11, true},
     {0x000001C0, 0x00081907, 0x00000014, 0x14030153, 0xCF0D0E24}},
    {{16, 0, 2208, 600, 50, 32, 0.15, false},
     {0x000001C4, 0x0008190C, 0x00000014, 0x13030153, 0xCF0D0E24}},
    {{16, 1, 2209, 1000, 25, 16, 0.11, true},
     {0x000001C0, 0x00081104, 0x00000014, 0x14010153, 0xCF0D0E24}},
    {{16, 0, 2209, 2000, 100, 256, 0.11, true},
     {0x000001C0, 0x00081F1F, 0x00000014, 0x10010153, 0xCF0D0E24}},
};

static void test_set_ups_are_the_captured_ones(void) {
    static const uint8_t addresses[] = {0x00, 0x10, 0x11, 0x6C, 0x70};
    for (size_t i = 0; i < COUNT_OF_ARRAY(golden); i++) {
        tmc22xx_write_t writes[TMC22XX_SETUP_WRITES];
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_setup_writes(&golden[i].settings, writes));
        for (size_t j = 0; j < TMC22XX_SETUP_WRITES; j++) {
            TEST_ASSERT_EQUAL_HEX8(addresses[j], writes[j].address);
            TEST_ASSERT_EQUAL_HEX32(golden[i].values[j], writes[j].value);
        }
    }
}

// What the registers mean is what was asked for, whatever it is.
static void test_set_ups_say_what_was_asked_for(void) {
    for (unsigned microsteps = 1; microsteps <= 256; microsteps *= 2) {
        for (int ma = 50; ma <= 2000; ma += 50) {
            tmc22xx_settings_t settings = plain();
            settings.microsteps = (uint16_t)microsteps;
            settings.run_ma = ma;
            settings.hold_percent = ma % 101;
            settings.stealth = ma % 100 == 0;
            tmc22xx_write_t writes[TMC22XX_SETUP_WRITES];
            tmc22xx_current_t current;
            TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_setup_writes(&settings, writes));
            TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_current(ma, settings.r_sense_ohm, &current));
            uint32_t ihold_irun = writes[1].value;
            uint32_t chopconf = writes[3].value;
            unsigned mres = TMC22XX_TAKE(chopconf, CHOPCONF, MRES);
            TEST_ASSERT_EQUAL_UINT(microsteps, tmc22xx_microsteps(mres));
            TEST_ASSERT_EQUAL(current.vsense, TMC22XX_TAKE(chopconf, CHOPCONF, vsense));
            TEST_ASSERT_EQUAL(current.scale, TMC22XX_TAKE(ihold_irun, IHOLD_IRUN, IRUN));
            TEST_ASSERT_EQUAL(current.scale * (ma % 101) / 100,
                              TMC22XX_TAKE(ihold_irun, IHOLD_IRUN, IHOLD));
            TEST_ASSERT_EQUAL(settings.stealth ? 0x1C0 : 0x1C4, writes[0].value);
        }
    }
}

// ---- Currents -----------------------------------------------------------------------------------

// The examples of the captured firmware, and real currents by the datasheet's table (section 9) for
// 0.11 ohm: 1.77 A at full scale, 0.98 A in the low range.
static void test_known_currents(void) {
    static const struct {
        double ma;
        uint8_t scale;
        bool vsense;
        bool limited;
        double real_ma;
    } known[] = {{100, 2, true, false, 92},      {500, 15, true, false, 490},
                 {800, 25, true, false, 795},    {900, 28, true, false, 887},
                 {1000, 17, false, false, 994},  {1500, 26, false, false, 1492},
                 {1770, 31, false, false, 1768}, {1800, 31, false, true, 1768},
                 {2000, 31, false, true, 1768}};
    for (size_t i = 0; i < COUNT_OF_ARRAY(known); i++) {
        tmc22xx_current_t current;
        TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_current(known[i].ma, 0.11, &current));
        TEST_ASSERT_EQUAL_UINT(known[i].scale, current.scale);
        TEST_ASSERT_EQUAL(known[i].vsense, current.vsense);
        TEST_ASSERT_EQUAL(known[i].limited, current.limited);
        TEST_ASSERT_DOUBLE_WITHIN(0.5, known[i].real_ma, current.real_ma);
    }
    TEST_ASSERT_DOUBLE_WITHIN(5, 1770, tmc22xx_scale_ma(31, false, 0.11));
    TEST_ASSERT_DOUBLE_WITHIN(5, 980, tmc22xx_scale_ma(31, true, 0.11));
}

// The datasheet's formula, written as it stands there.
static double rms_ma(unsigned cs, double full_scale_v, double r_sense_ohm) {
    return 1000.0 * (cs + 1) / 32.0 * full_scale_v / (r_sense_ohm + 0.020) / sqrt(2.0);
}

static void check_current(double ma, double r_sense_ohm, double *before_ma) {
    tmc22xx_current_t current = {0};
    double least_ma = rms_ma(0, 0.180, r_sense_ohm);
    err_t err = tmc22xx_current(ma, r_sense_ohm, &current);
    if (ma < 0.4999 * least_ma) {
        TEST_ASSERT_EQUAL(ERR_TMC_CURRENT, err);
        return;
    }
    if (err != ERR_OK) {
        TEST_ASSERT_TRUE(ma < 0.5001 * least_ma);
        return;
    }
    TEST_ASSERT_LESS_THAN_UINT(32, current.scale);
    TEST_ASSERT_TRUE(current.vsense || current.scale >= 16);
    double scale_v = current.vsense ? 0.180 : 0.325;
    double real_ma = rms_ma(current.scale, scale_v, r_sense_ohm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * real_ma, real_ma, current.real_ma);
    double step_ma = rms_ma(0, scale_v, r_sense_ohm);
    if (current.limited) {
        TEST_ASSERT_TRUE(current.scale == 31 && !current.vsense);
        TEST_ASSERT_TRUE(ma - real_ma > 0.4999 * step_ma);
    } else {
        TEST_ASSERT_DOUBLE_WITHIN(0.5001 * step_ma, ma, real_ma);
    }
    TEST_ASSERT_TRUE(real_ma >= *before_ma);
    *before_ma = real_ma;
}

static void test_the_real_current_is_the_nearest_there_is(void) {
    for (int milliohm = 80; milliohm <= 200; milliohm += 5) {
        double before_ma = 0.0;
        for (int ma = 1; ma <= 2000; ma++) {
            check_current(ma, milliohm / 1000.0, &before_ma);
        }
        TEST_ASSERT_TRUE(before_ma > 1000.0);
    }
}

static void test_currents_that_cannot_be_are_refused(void) {
    static const double refused[] = {0.0, -1.0, -800.0, 1.0, 15.0, -INFINITY, NAN};
    for (size_t i = 0; i < COUNT_OF_ARRAY(refused); i++) {
        tmc22xx_current_t current;
        memset(&current, 0x55, sizeof(current));
        tmc22xx_current_t before = current;
        TEST_ASSERT_EQUAL(ERR_TMC_CURRENT, tmc22xx_current(refused[i], 0.11, &current));
        TEST_ASSERT_EQUAL_MEMORY(&before, &current, sizeof(current));
    }
    TEST_ASSERT_EQUAL(ERR_TMC_CURRENT, tmc22xx_current(15, 0.11, &(tmc22xx_current_t){0}));
    TEST_ASSERT_EQUAL_STRING("Motor current 15 mA is too little (the least is 30.6 mA)",
                             err_message());
}

static void test_more_than_the_range_is_told(void) {
    tmc22xx_current_t current;
    TEST_ASSERT_EQUAL(ERR_OK, tmc22xx_current(INFINITY, 0.11, &current));
    TEST_ASSERT_TRUE(current.limited && current.scale == 31 && !current.vsense);
}

// ---- Microsteps and speeds ----------------------------------------------------------------------

static void test_microsteps(void) {
    static const unsigned of_mres[] = {256, 128, 64, 32, 16, 8, 4, 2, 1};
    unsigned valid = 0;
    for (unsigned microsteps = 0; microsteps < 70000; microsteps++) {
        int mres = tmc22xx_mres(microsteps);
        if (mres >= 0) {
            TEST_ASSERT_LESS_THAN_INT(9, mres);
            TEST_ASSERT_EQUAL_UINT(of_mres[mres], microsteps);
            valid++;
        }
    }
    TEST_ASSERT_EQUAL_UINT(COUNT_OF_ARRAY(of_mres), valid);
    for (unsigned mres = 0; mres < 16; mres++) {
        TEST_ASSERT_EQUAL_UINT(mres < 9 ? of_mres[mres] : 0, tmc22xx_microsteps(mres));
    }
}

// 60,000 microsteps of 1/256 a second are 234 full steps: 70 rpm of a motor of 1.8 degrees.
static void test_known_speeds(void) {
    TEST_ASSERT_EQUAL_UINT32(200, tmc22xx_tstep(3750.0, 16));
    TEST_ASSERT_EQUAL_DOUBLE(3750.0, tmc22xx_steps_per_s(200, 16));
    TEST_ASSERT_EQUAL_UINT32(200, tmc22xx_tstep(60000.0, 256));
    TEST_ASSERT_EQUAL_DOUBLE(234.375, tmc22xx_steps_per_s(200, 1));
}

static void test_speeds_there_and_back(void) {
    for (unsigned microsteps = 1; microsteps <= 256; microsteps *= 2) {
        for (uint32_t tstep = 1; tstep < TMC22XX_TSTEP_MAX; tstep += 1 + tstep / 5000) {
            double steps_per_s = tmc22xx_steps_per_s(tstep, microsteps);
            TEST_ASSERT_EQUAL_UINT32(tstep, tmc22xx_tstep(steps_per_s, microsteps));
        }
    }
}

static void test_speeds_beyond_the_register(void) {
    TEST_ASSERT_EQUAL_UINT32(TMC22XX_TSTEP_MAX, tmc22xx_tstep(0.0, 16));
    TEST_ASSERT_EQUAL_UINT32(TMC22XX_TSTEP_MAX, tmc22xx_tstep(1e-9, 16));
    TEST_ASSERT_EQUAL_UINT32(TMC22XX_TSTEP_MAX, tmc22xx_tstep(NAN, 16));
    TEST_ASSERT_EQUAL_UINT32(1, tmc22xx_tstep(1e12, 16));
    TEST_ASSERT_EQUAL_UINT32(1, tmc22xx_tstep(INFINITY, 16));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, tmc22xx_steps_per_s(TMC22XX_TSTEP_MAX, 16));
    TEST_ASSERT_EQUAL_DOUBLE(750000.0, tmc22xx_steps_per_s(0, 16));
}

// ---- Refused set-ups ----------------------------------------------------------------------------

static void assert_refused(const tmc22xx_settings_t *settings, err_t expected, const char *text) {
    tmc22xx_write_t writes[TMC22XX_SETUP_WRITES];
    memset(writes, 0x55, sizeof(writes));
    tmc22xx_write_t before[TMC22XX_SETUP_WRITES];
    memcpy(before, writes, sizeof(writes));
    TEST_ASSERT_EQUAL(expected, tmc22xx_setup_writes(settings, writes));
    TEST_ASSERT_EQUAL_STRING(text, err_message());
    TEST_ASSERT_EQUAL_MEMORY(before, writes, sizeof(writes));
}

#define ASSERT_REFUSED(field, wrong, expected, text)                                               \
    do {                                                                                           \
        tmc22xx_settings_t settings = plain();                                                     \
        settings.field = (wrong);                                                                  \
        assert_refused(&settings, ERR_##expected, (text));                                         \
    } while (false)

static void test_set_ups_that_cannot_be_are_refused(void) {
    ASSERT_REFUSED(chip, 2130, TMC_CHIP, "Chip type must be 2208 or 2209");
    ASSERT_REFUSED(chip, 0, TMC_CHIP, "Chip type must be 2208 or 2209");
    ASSERT_REFUSED(address, 4, TMC_ADDRESS, "Address 4: a TMC2209 has address 0 to 3");
    ASSERT_REFUSED(microsteps, 0, TMC_MICROSTEPS,
                   "Microsteps must be one of: 1, 2, 4, 8, 16, 32, 64, 128, or 256");
    ASSERT_REFUSED(microsteps, 512, TMC_MICROSTEPS,
                   "Microsteps must be one of: 1, 2, 4, 8, 16, 32, 64, 128, or 256");
    ASSERT_REFUSED(microsteps, 3, TMC_MICROSTEPS,
                   "Microsteps must be one of: 1, 2, 4, 8, 16, 32, 64, 128, or 256");
    ASSERT_REFUSED(hold_percent, -0.1, ARGUMENT, "hold_pct must be 0 to 100");
    ASSERT_REFUSED(hold_percent, 100.1, ARGUMENT, "hold_pct must be 0 to 100");
    ASSERT_REFUSED(hold_percent, NAN, ARGUMENT, "hold_pct must be 0 to 100");
    ASSERT_REFUSED(r_sense_ohm, 0.07, ARGUMENT, "r_sense must be 0.08 to 0.2");
    ASSERT_REFUSED(r_sense_ohm, 0.21, ARGUMENT, "r_sense must be 0.08 to 0.2");
    ASSERT_REFUSED(r_sense_ohm, NAN, ARGUMENT, "r_sense must be 0.08 to 0.2");
    ASSERT_REFUSED(run_ma, 0, TMC_CURRENT,
                   "Motor current 0 mA is too little (the least is 30.6 mA)");
    tmc22xx_settings_t settings = plain();
    settings.chip = 2208;
    settings.address = 1;
    assert_refused(&settings, ERR_TMC_ADDRESS, "Address 1: a TMC2208 has address 0");
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_set_ups_are_the_captured_ones);
    RUN_TEST(test_set_ups_say_what_was_asked_for);
    RUN_TEST(test_known_currents);
    RUN_TEST(test_the_real_current_is_the_nearest_there_is);
    RUN_TEST(test_currents_that_cannot_be_are_refused);
    RUN_TEST(test_more_than_the_range_is_told);
    RUN_TEST(test_microsteps);
    RUN_TEST(test_known_speeds);
    RUN_TEST(test_speeds_there_and_back);
    RUN_TEST(test_speeds_beyond_the_register);
    RUN_TEST(test_set_ups_that_cannot_be_are_refused);
    return UNITY_END();
}
