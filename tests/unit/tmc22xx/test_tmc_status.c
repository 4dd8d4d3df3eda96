// Conditions: each bit of the status registers says what the datasheet says, alone and with others.
#include "tmc22xx/status.h"

#include <string.h>
#include <unity.h>

#include "base/base.h"

#define GSTAT 0x01
#define IOIN 0x06
#define DRV_STATUS 0x6F
#define STST 0x80000000u
#define STEALTH 0x40000000u

void setUp(void) {}
void tearDown(void) {}

// The texts of a value, in the table's order, with a semicolon behind each.
static const char *texts_of(uint8_t reg, uint32_t value) {
    static char text[600];
    uint32_t holding = tmc22xx_conditions_of(reg, value);
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < tmc22xx_condition_count; i++) {
        if ((holding >> i & 1) != 0) {
            TEST_ASSERT_EQUAL_HEX8(reg, tmc22xx_conditions[i].reg);
            length += format_text(text + length, sizeof(text) - length, "%s;",
                                  tmc22xx_conditions[i].text);
            TEST_ASSERT_LESS_THAN_size_t(sizeof(text), length);
        }
    }
    return text;
}

static void test_what_each_bit_says(void) {
    static const struct {
        uint8_t reg;
        uint32_t value;
        const char *text;
    } cases[] = {
        {GSTAT, 0, ""},
        {GSTAT, 1, "it has lost its settings (was its power off?);"},
        {GSTAT, 2, "the motor was switched off by heat or a short circuit;"},
        {GSTAT, 4, "motor off: supply voltage too low (charge pump);"},
        {IOIN, 0x21000001, "motor off by the enable pin;"},
        {IOIN, 0x21000040, "enabled by the enable pin;"},
        {DRV_STATUS, 0, "in motion;SpreadCycle;"},
        {DRV_STATUS, STEALTH, "in motion;StealthChop;"},
        {DRV_STATUS, STST | STEALTH, "standstill;StealthChop;"},
        {DRV_STATUS, STST | 1, "the driver is hot (temperature warning);standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 2, "motor off: the driver is overheated;standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 3, "motor off: the driver is overheated;standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 4, "motor coil A: short to ground;standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 8, "motor coil B: short to ground;standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 16, "motor coil A: short to the supply;standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 32, "motor coil B: short to the supply;standstill;SpreadCycle;"},
        {DRV_STATUS, 64, "motor coil A: seems not connected;in motion;SpreadCycle;"},
        {DRV_STATUS, 128, "motor coil B: seems not connected;in motion;SpreadCycle;"},
        // At standstill an open coil cannot be told; temperatures and current are no conditions.
        {DRV_STATUS, STST | 192, "standstill;SpreadCycle;"},
        {DRV_STATUS, STST | 0x001F0F00, "standstill;SpreadCycle;"},
        // A register that has none.
        {0x00, 0xFFFFFFFF, ""},
    };
    for (size_t i = 0; i < COUNT_OF_ARRAY(cases); i++) {
        TEST_ASSERT_EQUAL_STRING(cases[i].text, texts_of(cases[i].reg, cases[i].value));
    }
}

// Whatever a value is, the gravest comes first, and every flag of a fault is told.
static void test_gravest_first_and_none_lost(void) {
    static const struct {
        uint8_t reg;
        uint32_t faults;
    } registers[] = {{GSTAT, 0x05}, {DRV_STATUS, 0x3E}};
    for (size_t i = 0; i < COUNT_OF_ARRAY(registers); i++) {
        for (uint32_t value = 0; value < 0x100; value++) {
            uint32_t holding = tmc22xx_conditions_of(registers[i].reg, value);
            unsigned before = TMC22XX_FAULT;
            unsigned faults = 0;
            for (size_t j = 0; j < tmc22xx_condition_count; j++) {
                if ((holding >> j & 1) != 0) {
                    unsigned severity = tmc22xx_conditions[j].severity;
                    TEST_ASSERT_TRUE(severity <= before);
                    before = severity;
                    faults += severity == TMC22XX_FAULT;
                }
            }
            TEST_ASSERT_EQUAL_INT(__builtin_popcount(value & registers[i].faults), faults);
        }
    }
}

static void test_temperatures(void) {
    TEST_ASSERT_EQUAL_UINT(0, tmc22xx_temperature(0xFFFFF0FF));
    TEST_ASSERT_EQUAL_UINT(120, tmc22xx_temperature(0x0100));
    TEST_ASSERT_EQUAL_UINT(143, tmc22xx_temperature(0x0300));
    TEST_ASSERT_EQUAL_UINT(150, tmc22xx_temperature(0x0700));
    TEST_ASSERT_EQUAL_UINT(157, tmc22xx_temperature(0x0F00));
    TEST_ASSERT_EQUAL_UINT(157, tmc22xx_temperature(0x0800));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_each_bit_says);
    RUN_TEST(test_gravest_first_and_none_lost);
    RUN_TEST(test_temperatures);
    return UNITY_END();
}
