// What a simulated driver tells by itself: stalls, heat, shorts, obstacles; and lost settings.
#include <unity.h>

#include "chip.h"
#include "hal/hal.h"

void setUp(void) {
    chip_renew();
}
void tearDown(void) {}

// ---- The stall output ---------------------------------------------------------------------------

static void arm(void) {
    chip_put(SGTHRS, 120);
    chip_put(TCOOLTHRS, 200);
}

static void test_a_stall_shows_within_two_full_steps(void) {
    arm();
    chip.motor.stop_high = 100 * 256;
    chip_steps(16 * 100, true, 100);
    TEST_ASSERT_FALSE(chip_diag());
    unsigned until = 0;
    while (!chip_diag() && until < 100) {
        chip_steps(1, true, 100);
        until++;
    }
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(32, until);
    for (unsigned i = 0; i < 300; i++) {
        chip_steps(1, true, 100);
        TEST_ASSERT_TRUE(chip_diag()); // it does not recover in between
    }
    TEST_ASSERT_EQUAL_UINT32(0, chip_get(SG_RESULT));
    TEST_ASSERT_EQUAL_HEX32(0x10, chip_get(IOIN) & 0x10);
}

// 201 step times behind the last pulse, and not at the next event of something else.
static void test_diag_falls_when_the_pulses_end(void) {
    arm();
    chip.motor.stop_high = 1000;
    chip_steps(200, true, 100);
    TEST_ASSERT_TRUE(chip_diag());
    chip_wait_us(260);
    TEST_ASSERT_TRUE(chip_diag());
    chip_wait_us(10);
    TEST_ASSERT_FALSE(chip_diag());
}

static void test_each_gate_of_the_stall_output(void) {
    static const struct {
        uint32_t sgthrs, tcoolthrs, tpwmthrs, gconf;
        bool diag;
    } cases[] = {
        {120, 75, 0, 0x1C0, true},    // TSTEP is 75
        {120, 74, 0, 0x1C0, false},   // too slow
        {120, 0, 0, 0x1C0, false},    // disarmed
        {120, 200, 74, 0x1C0, true},  // just slow enough for StealthChop
        {120, 200, 75, 0x1C0, false}, // TSTEP > TPWMTHRS it is not
        {120, 200, 0, 0x1C4, false},  // SpreadCycle
        {0, 200, 0, 0x1C0, true},     // 0 <= 0, by the letter
    };
    for (unsigned i = 0; i < COUNT_OF_ARRAY(cases); i++) {
        setUp();
        chip_put(SGTHRS, cases[i].sgthrs);
        chip_put(TCOOLTHRS, cases[i].tcoolthrs);
        chip_put(TPWMTHRS, cases[i].tpwmthrs);
        chip_put(GCONF, cases[i].gconf);
        chip.motor.stop_high = 1000;
        chip_steps(400, true, 100);
        char number[2] = {(char)('0' + i), '\0'};
        TEST_ASSERT_EQUAL_MESSAGE(cases[i].diag, chip_diag(), number);
        chip.motor.stop_high = SIMULATE_MOTOR_NO_END;
    }
}

static void test_a_higher_threshold_is_more_sensitive(void) {
    chip_put(TCOOLTHRS, 200);
    chip_put(SGTHRS, 120);
    chip_steps(800, true, 100);
    TEST_ASSERT_FALSE(chip_diag());
    chip.motor.load_ma = 600;
    chip_steps(80, true, 100);
    TEST_ASSERT_TRUE(chip_diag());
    chip_put(SGTHRS, 20);
    chip_steps(80, true, 100);
    TEST_ASSERT_FALSE(chip_diag());
}

// ---- Faults -------------------------------------------------------------------------------------

static void set_fault(simulate_chip_fault_t fault, int32_t value, unsigned in_us) {
    simulate_faults_set(&chip.faults, fault, chip_now_ns() + in_us * 1000u, UINT64_MAX);
    simulate_faults_limit(&chip.faults, fault, value);
}

static void test_brown_out_forgets_and_moves_otherwise(void) {
    arm();
    chip_steps(40, true, 100);
    int64_t before = chip_axis.position_steps;
    set_fault(SIMULATE_CHIP_BROWN_OUT, 0, 500);
    chip_wait_us(499);
    TEST_ASSERT_EQUAL_UINT32(8, chip_get(IFCNT));
    chip_wait_us(2);
    TEST_ASSERT_EQUAL_UINT32(0, chip_get(IFCNT));
    TEST_ASSERT_EQUAL_UINT32(1, chip_get(GSTAT));
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, TCOOLTHRS, chip_now_ns()));
    TEST_ASSERT_EQUAL_UINT32(0, chip_get(MSCNT)); // the rotor jumps there
    TEST_ASSERT_INT64_WITHIN(32, before, chip_axis.position_steps);
    before = chip_axis.position_steps;
    chip_steps(100, true, 100);
    TEST_ASSERT_INT64_WITHIN(1, before + 200, chip_axis.position_steps); // 8 instead of 16
    chip_put(GSTAT, 1);
    chip_wait_us(1000);
    TEST_ASSERT_EQUAL_UINT32(0, chip_get(GSTAT)); // it happens once
}

static void test_temperatures(void) {
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 119, 0);
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(DRV_STATUS) & 0xFFF);
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 130, 0);
    TEST_ASSERT_EQUAL_HEX32(0x101, chip_get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_FALSE(chip_diag()); // a warning is only told
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(GSTAT));
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 145, 0);
    TEST_ASSERT_EQUAL_HEX32(0x303, chip_get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_EQUAL_HEX32(2, chip_get(GSTAT));
    TEST_ASSERT_TRUE(chip_diag());
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_current_ma(&chip, chip_now_ns()));
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 125, 0); // stays off until the warning is over
    TEST_ASSERT_EQUAL_HEX32(0x103, chip_get(DRV_STATUS) & 0xFFF);
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 100, 0);
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_TRUE(chip_diag()); // the error is kept
    chip_put(GSTAT, 2);
    TEST_ASSERT_FALSE(chip_diag());
    chip_put(FACTORY_CONF, 3u << 8);
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 150, 0);
    TEST_ASSERT_EQUAL_HEX32(0x701, chip_get(DRV_STATUS) & 0xFFF);
}

// Without anybody asking, at its time.
static void test_a_short_raises_diag_by_itself(void) {
    set_fault(SIMULATE_CHIP_SHORT, 0, 700);
    chip_wait_us(699);
    TEST_ASSERT_FALSE(chip_diag());
    chip_wait_us(2);
    TEST_ASSERT_TRUE(chip_diag());
    TEST_ASSERT_EQUAL_HEX32(4, chip_get(DRV_STATUS) & 0xFFF);
    chip_put(GSTAT, 7);
    TEST_ASSERT_EQUAL_HEX32(2, chip_get(GSTAT)); // it is still there
    simulate_faults_set(&chip.faults, SIMULATE_CHIP_SHORT, 0, 0);
    chip_put(GSTAT, 7);
    TEST_ASSERT_FALSE(chip_diag());
    set_fault(SIMULATE_CHIP_OPEN_LOAD, 0, 0);
    TEST_ASSERT_EQUAL_HEX32(0x40, chip_get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_FALSE(chip_diag());
}

static void test_faults_that_pass(void) {
    simulate_faults_set(&chip.faults, SIMULATE_CHIP_OVER_TEMPERATURE, chip_now_ns() + 1000000,
                        chip_now_ns() + 2000000);
    simulate_faults_limit(&chip.faults, SIMULATE_CHIP_OVER_TEMPERATURE, 160);
    chip_wait_us(1500);
    TEST_ASSERT_TRUE(chip_diag());
    chip_wait_us(1000);
    TEST_ASSERT_EQUAL_HEX32(0, chip_get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_EQUAL_HEX32(2, chip_get(GSTAT));
    simulate_faults_set(&chip.faults, SIMULATE_CHIP_UNPOWERED, chip_now_ns(),
                        chip_now_ns() + 1000000);
    chip_wait_us(500);
    int64_t before = chip_axis.position_steps;
    chip_steps(4, true, 100);
    TEST_ASSERT_EQUAL_INT64(before, chip_axis.position_steps);
    chip_wait_us(500);
    TEST_ASSERT_EQUAL_HEX32(1, chip_get(GSTAT)); // all is lost when it comes back
    TEST_ASSERT_EQUAL_UINT32(8, simulate_tmc_microsteps(&chip));
}

static void test_an_obstacle_at_a_place_from_a_time_on(void) {
    arm();
    set_fault(SIMULATE_CHIP_STALL, 60, 10000);
    chip_steps(70, true, 100);
    TEST_ASSERT_INT64_WITHIN(2, 70, chip_axis.position_steps);
    chip_steps(70, false, 100);
    chip_wait_us(1000);
    chip_steps(200, true, 100);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(60, chip_axis.position_steps);
    TEST_ASSERT_TRUE(chip_diag());
    TEST_ASSERT_GREATER_THAN_UINT64(0, chip.motor.slips);
}

static void test_switched_off_the_motor_does_not_move(void) {
    chip_steps(20, true, 100);
    int64_t before = chip_axis.position_steps;
    hal_pins_set(1u << CHIP_ENABLE);
    chip_steps(128, true, 100);
    TEST_ASSERT_EQUAL_INT64(before, chip_axis.position_steps);
    TEST_ASSERT_EQUAL_HEX32(1, chip_get(IOIN) & 1);
    hal_pins_clear(1u << CHIP_ENABLE);
    chip_steps(64, true, 100);
    TEST_ASSERT_INT64_WITHIN(1, before + 64, chip_axis.position_steps);
}

static void test_the_place_of_the_axis_is_that_of_the_rotor(void) {
    chip_put(CHOPCONF, 0x12030153); // 64 microsteps; places count 16
    chip.motor.load_ma = 0;
    chip_steps(400, true, 100);
    TEST_ASSERT_EQUAL_INT64(100, chip_axis.position_steps);
    chip_steps(802, false, 100);
    TEST_ASSERT_EQUAL_INT64(-100, chip_axis.position_steps); // -100.5
    chip_steps(1, false, 100);
    TEST_ASSERT_EQUAL_INT64(-101, chip_axis.position_steps);
}

int main(void) {
    UNITY_BEGIN();
    chip_attach();
    RUN_TEST(test_a_stall_shows_within_two_full_steps);
    RUN_TEST(test_diag_falls_when_the_pulses_end);
    RUN_TEST(test_each_gate_of_the_stall_output);
    RUN_TEST(test_a_higher_threshold_is_more_sensitive);
    RUN_TEST(test_brown_out_forgets_and_moves_otherwise);
    RUN_TEST(test_temperatures);
    RUN_TEST(test_a_short_raises_diag_by_itself);
    RUN_TEST(test_faults_that_pass);
    RUN_TEST(test_an_obstacle_at_a_place_from_a_time_on);
    RUN_TEST(test_switched_off_the_motor_does_not_move);
    RUN_TEST(test_the_place_of_the_axis_is_that_of_the_rotor);
    return UNITY_END();
}
