// The registers of a simulated driver, and what its motor does to them: step time, load, current.
#include <unity.h>

#include "chip.h"
#include "hal/hal.h"

void setUp(void) {
    chip_renew();
}
void tearDown(void) {}

// ---- Registers ----------------------------------------------------------------------------------

static void test_reset_values(void) {
    simulate_tmc_reset(&chip, chip_now_ns());
    TEST_ASSERT_EQUAL_HEX32(0x101, chip_get(GCONF));
    TEST_ASSERT_EQUAL_HEX32(1, chip_get(GSTAT));
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(IFCNT));
    TEST_ASSERT_EQUAL_HEX32(0x21000040, chip_get(IOIN) & ~0x200u); // but CHIP_DIR
    TEST_ASSERT_EQUAL_HEX32(0xFFFFF, chip_get(TSTEP));
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(MSCNT));
    TEST_ASSERT_EQUAL_HEX32(0x10000053, chip_get(CHOPCONF));
    TEST_ASSERT_EQUAL_HEX32(0xC10D0024, chip_get(PWMCONF));
    TEST_ASSERT_EQUAL_HEX32(0xC01F0000, chip_get(DRV_STATUS)); // stands, StealthChop, still at IRUN
    TEST_ASSERT_EQUAL_UINT32(8, simulate_tmc_microsteps(&chip));
}

static void test_gstat_is_cleared_by_ones(void) {
    simulate_tmc_reset(&chip, chip_now_ns());
    chip_put(GSTAT, 2);
    TEST_ASSERT_EQUAL_HEX32(1, chip_get(GSTAT));
    chip_put(GSTAT, 1);
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(GSTAT));
    TEST_ASSERT_EQUAL_UINT32(2, chip_get(IFCNT));
}

static void test_bits_that_are_not_there_are_not_kept(void) {
    chip_put(GCONF, UINT32_MAX);
    TEST_ASSERT_EQUAL_HEX32(0x3FF, chip_get(GCONF));
    chip_put(PWMCONF, UINT32_MAX);
    TEST_ASSERT_EQUAL_HEX32(0xFF3FFFFF, chip_get(PWMCONF));
}

static void test_microsteps_by_pins_and_by_register(void) {
    static const unsigned of_2209[] = {8, 32, 64, 16};
    static const unsigned of_2208[] = {8, 2, 4, 16};
    for (unsigned resolution = 0; resolution <= 8; resolution++) {
        chip_put(CHOPCONF, 0x10000053 | resolution << 24);
        TEST_ASSERT_EQUAL_UINT32(256u >> resolution, simulate_tmc_microsteps(&chip));
    }
    chip_put(GCONF, 0x140);
    for (unsigned pins = 0; pins < 4; pins++) {
        chip.address = pins;
        TEST_ASSERT_EQUAL_UINT32(of_2209[pins], simulate_tmc_microsteps(&chip));
        chip.chip = 2208;
        TEST_ASSERT_EQUAL_UINT32(of_2208[pins], simulate_tmc_microsteps(&chip));
        chip.chip = 2209;
    }
    chip.address = 0;
}

static void test_a_2208_has_no_stallguard(void) {
    chip.chip = 2208;
    chip_put(SGTHRS, 100);
    chip_put(TCOOLTHRS, 100);
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, SGTHRS, chip_now_ns()));
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, TCOOLTHRS, chip_now_ns()));
    TEST_ASSERT_NULL(simulate_tmc_name(&chip, SG_RESULT));
    TEST_ASSERT_EQUAL_HEX32(0x20000140, chip_get(IOIN) & ~0x200u);
    chip.chip = 2209;
}

// ---- Current ------------------------------------------------------------------------------------

// Worked out by hand: (CS + 1) / 32 * Vfs / (Rs + 20 mohm) / sqrt(2).
static void test_currents(void) {
    static const struct {
        uint32_t cs, vsense, ma;
    } cases[] = {{2, 1, 92}, {15, 1, 490}, {25, 1, 795}, {17, 0, 994}, {31, 0, 1768}};
    for (unsigned i = 0; i < COUNT_OF_ARRAY(cases); i++) {
        chip_put(IHOLD_IRUN, cases[i].cs << 8);
        chip_put(CHOPCONF, 0x14010153 | cases[i].vsense << 17);
        chip_steps(1, true, 1000);
        TEST_ASSERT_UINT32_WITHIN(1, cases[i].ma, simulate_tmc_current_ma(&chip, chip_now_ns()));
    }
}

static uint32_t current_scale(void) {
    return chip_get(DRV_STATUS) >> 16 & 31;
}

// 20 and then 8 times 2^18 clocks of 12 MHz: 437 ms and 175 ms each.
static void test_at_a_standstill_the_current_goes_down(void) {
    chip_steps(1, true, 100);
    chip_wait_us(430000);
    TEST_ASSERT_EQUAL_UINT32(25, current_scale());
    chip_wait_us(10000);
    TEST_ASSERT_EQUAL_UINT32(24, current_scale());
    chip_wait_us(175000);
    TEST_ASSERT_EQUAL_UINT32(23, current_scale());
    chip_wait_us(4000000);
    TEST_ASSERT_EQUAL_UINT32(7, current_scale());
    chip_steps(1, true, 100);
    TEST_ASSERT_EQUAL_UINT32(25, current_scale());
}

static void test_coolstep_saves_current_and_gives_it_back(void) {
    chip_put(TCOOLTHRS, 200);
    chip_put(COOLCONF, 2 | 3u << 5 | 1u << 8 | 3u << 13); // up by 8, down at every measurement
    chip_steps(16 * 40, true, 100);
    TEST_ASSERT_EQUAL_UINT32(12, current_scale()); // half of 25, as seimin says
    chip.motor.load_ma = 380;                      // nearly all that half gives
    chip_steps(16 * 2, true, 100);
    TEST_ASSERT_GREATER_THAN_UINT32(16, current_scale());
    chip_put(COOLCONF, 0);
    chip_steps(16 * 2, true, 100);
    TEST_ASSERT_EQUAL_UINT32(25, current_scale());
}

// ---- Speed --------------------------------------------------------------------------------------

static void test_step_time(void) {
    chip_steps(40, true, 100); // 1200 clocks for 16 of 256
    TEST_ASSERT_EQUAL_UINT32(75, chip_get(TSTEP));
    chip_wait_us(200);
    TEST_ASSERT_EQUAL_UINT32(150, chip_get(TSTEP));
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(DRV_STATUS) >> 31);
    chip_wait_us(87000);
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(DRV_STATUS) >> 31);
    chip_wait_us(400);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFF, chip_get(TSTEP));
    TEST_ASSERT_EQUAL_HEX32(1, chip_get(DRV_STATUS) >> 31);
    chip_put(CHOPCONF, 0x15030153); // 8 microsteps
    chip_steps(40, true, 100);
    TEST_ASSERT_EQUAL_UINT32(37, chip_get(TSTEP));
}

static void test_step_time_is_a_mean(void) {
    for (unsigned i = 0; i < 20; i++) {
        chip_steps(1, true, 70);
        chip_steps(1, true, 80);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 56, chip_get(TSTEP));
}

static void test_mscnt_counts_with_the_field(void) {
    chip_steps(3, true, 100);
    TEST_ASSERT_EQUAL_UINT32(48, chip_get(MSCNT));
    chip_steps(4, false, 100);
    TEST_ASSERT_EQUAL_UINT32(1008, chip_get(MSCNT));
    chip_put(GCONF, 0x1C8); // shaft
    chip_steps(1, false, 100);
    TEST_ASSERT_EQUAL_UINT32(0, chip_get(MSCNT));
    chip_steps(3200, false, 100);
    TEST_ASSERT_INT64_WITHIN(1, 3200, chip_axis.position_steps);
}

static uint32_t mean_load(unsigned every_us) {
    uint32_t sum = 0;
    chip_steps(160, true, every_us);
    for (unsigned i = 0; i < 90; i++) {
        chip_steps(16, true, every_us);
        sum += chip_get(SG_RESULT);
    }
    return sum / 90;
}

// Free: it grows with the speed; with load it falls.
static void test_load_by_speed_and_friction(void) {
    static const unsigned every_us[] = {1000, 500, 250, 100, 50};
    uint32_t last = 0;
    chip.motor.load_ma = 0;
    for (unsigned i = 0; i < COUNT_OF_ARRAY(every_us); i++) {
        uint32_t value = mean_load(every_us[i]);
        double speed = 62500.0 / every_us[i];
        TEST_ASSERT_UINT32_WITHIN(8, (uint32_t)(510 * speed / (speed + 60)), value);
        TEST_ASSERT_GREATER_THAN_UINT32(last, value);
        last = value;
    }
    for (chip.motor.load_ma = 100; chip.motor.load_ma < 800; chip.motor.load_ma += 100) {
        uint32_t value = mean_load(50);
        TEST_ASSERT_LESS_THAN_UINT32(last, value);
        last = value;
    }
    TEST_ASSERT_LESS_THAN_UINT32(80, last);
    chip_put(GCONF, 0x1C4); // SpreadCycle
    TEST_ASSERT_EQUAL_UINT32(0, mean_load(50));
}

int main(void) {
    UNITY_BEGIN();
    chip_attach();
    RUN_TEST(test_reset_values);
    RUN_TEST(test_gstat_is_cleared_by_ones);
    RUN_TEST(test_bits_that_are_not_there_are_not_kept);
    RUN_TEST(test_microsteps_by_pins_and_by_register);
    RUN_TEST(test_a_2208_has_no_stallguard);
    RUN_TEST(test_currents);
    RUN_TEST(test_at_a_standstill_the_current_goes_down);
    RUN_TEST(test_coolstep_saves_current_and_gives_it_back);
    RUN_TEST(test_step_time);
    RUN_TEST(test_step_time_is_a_mean);
    RUN_TEST(test_mscnt_counts_with_the_field);
    RUN_TEST(test_load_by_speed_and_friction);
    return UNITY_END();
}
