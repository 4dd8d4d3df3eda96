// The table of registers against the simulated drivers, which were written from the datasheets
// without it: names, reset values, access and bits of each chip; and checksums.
#include <string.h>
#include <unity.h>

#include "base/base.h"
#include "simulate_tmc.h"
#include "simulate_tmc_wire.h"
#include "tmc22xx/datagram.h"
#include "tmc22xx/tmc22xx_registers.h"

#define NOW_NS 1000000000u // since power-up

static simulate_tmc_t driver;

void setUp(void) {}
void tearDown(void) {}

static void power_up(unsigned chip) {
    simulate_tmc_init(&driver);
    driver.chip = (uint16_t)chip;
    simulate_motor_init(&driver.motor, 0);
    simulate_tmc_reset(&driver, 0);
}

// The bits that a chip has fields for.
static uint32_t bits_of(const tmc22xx_register_t *reg, unsigned chip) {
    uint32_t bits = 0;
    for (unsigned i = 0; i < reg->field_count; i++) {
        const tmc22xx_field_t *field = &reg->fields[i];
        if ((field->chips & tmc22xx_chip_bit(chip)) != 0) {
            bits |= (0xFFFFFFFFu >> (32 - field->bits)) << field->low_bit;
        }
    }
    return bits;
}

static const tmc22xx_register_t *of_chip(unsigned address, unsigned chip) {
    const tmc22xx_register_t *reg = tmc22xx_register_at(address);
    return reg != NULL && (reg->chips & tmc22xx_chip_bit(chip)) != 0 ? reg : NULL;
}

// Calls `check` for each address of each chip, at power-up.
static void for_all(void (*check)(unsigned chip, unsigned address, const tmc22xx_register_t *reg)) {
    for (unsigned chip = 2208; chip <= 2209; chip++) {
        for (unsigned address = 0; address < SIMULATE_TMC_REGISTERS; address++) {
            power_up(chip);
            check(chip, address, of_chip(address, chip));
        }
    }
}

static void check_name(unsigned chip, unsigned address, const tmc22xx_register_t *reg) {
    (void)chip;
    const char *name = simulate_tmc_name(&driver, address);
    TEST_ASSERT_EQUAL(reg != NULL, name != NULL);
    if (reg != NULL) { // by another name, maybe: SLAVECONF
        TEST_ASSERT_EQUAL_PTR(reg, tmc22xx_register(name, strlen(name)));
    }
}

static void test_both_know_the_same_registers(void) {
    for_all(check_name);
}

// The clock's trimming is each chip's own.
static uint32_t trimming(unsigned address) {
    return address == TMC22XX_REG_FACTORY_CONF ? TMC22XX_MASK(FACTORY_CONF, FCLKTRIM) : 0;
}

static void check_reset(unsigned chip, unsigned address, const tmc22xx_register_t *reg) {
    (void)chip;
    if (reg != NULL && reg->access != TMC22XX_READ) {
        uint32_t value = simulate_tmc_register(&driver, address, NOW_NS);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(reg->reset, value & ~trimming(address), reg->name);
    }
}

static void test_both_begin_with_the_same_values(void) {
    for_all(check_reset);
}

// Nobody can tell whether a register that is only written keeps bits which do nothing.
static uint32_t unseen(const tmc22xx_register_t *reg, unsigned chip) {
    return (reg->access & TMC22XX_READ) != 0 ? 0 : ~bits_of(reg, chip);
}

static void check_access(unsigned chip, unsigned address, const tmc22xx_register_t *reg) {
    uint32_t before = simulate_tmc_register(&driver, address, NOW_NS);
    simulate_tmc_write(&driver, address, 0xFFFFFFFFu, NOW_NS);
    uint32_t after = simulate_tmc_register(&driver, address, NOW_NS);
    uint32_t seen = simulate_tmc_read(&driver, address, NOW_NS);
    if (reg == NULL) {
        TEST_ASSERT_EQUAL_HEX32(0, seen);
        return;
    }
    if ((reg->access & TMC22XX_WRITE) != 0) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(reg, chip), after & ~unseen(reg, chip), reg->name);
    } else if ((reg->access & TMC22XX_CLEAR) != 0) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, after, reg->name);
    } else if (address != TMC22XX_REG_IFCNT) { // which counts the write
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(before, after, reg->name);
    }
    TEST_ASSERT_EQUAL_HEX32_MESSAGE((reg->access & TMC22XX_READ) != 0 ? after : 0, seen, reg->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, (before | seen) & ~bits_of(reg, chip), reg->name);
}

static void test_both_allow_the_same(void) {
    for_all(check_access);
}

static void test_the_version_tells_the_chip(void) {
    static const struct {
        unsigned chip;
        uint32_t version;
    } chips[] = {{2208, 0x20}, {2209, 0x21}};
    for (size_t i = 0; i < COUNT_OF_ARRAY(chips); i++) {
        power_up(chips[i].chip);
        uint32_t pins = simulate_tmc_read(&driver, TMC22XX_REG_IOIN, NOW_NS);
        TEST_ASSERT_EQUAL_HEX32(chips[i].version, TMC22XX_TAKE(pins, IOIN, VERSION));
    }
}

static void test_checksums_are_the_same(void) {
    for (unsigned reg = 0; reg < 0x100; reg++) {
        uint8_t frame[DATAGRAM_WRITE_SIZE];
        datagram_write(frame, (uint8_t)(reg & 3), (uint8_t)reg, 0x9E3779B9u * (reg + 1));
        TEST_ASSERT_EQUAL_HEX8(simulate_tmc_wire_checksum(frame, 7), frame[7]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_both_know_the_same_registers);
    RUN_TEST(test_both_begin_with_the_same_values);
    RUN_TEST(test_both_allow_the_same);
    RUN_TEST(test_the_version_tells_the_chip);
    RUN_TEST(test_checksums_are_the_same);
    return UNITY_END();
}
