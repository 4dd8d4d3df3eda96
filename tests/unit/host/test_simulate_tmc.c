// The registers of a simulated driver, and what its motor does to them: step time, load, current,
// temperature, the stall output.
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"
#include "simulate_tmc.h"

#define STEP 2u
#define DIR 3u
#define DIAG 10u
#define ENABLE 4u

enum {
    GCONF = 0x00,
    GSTAT = 0x01,
    IFCNT = 0x02,
    IOIN = 0x06,
    FACTORY_CONF = 0x07,
    IHOLD_IRUN = 0x10,
    TPOWERDOWN = 0x11,
    TSTEP = 0x12,
    TPWMTHRS = 0x13,
    TCOOLTHRS = 0x14,
    SGTHRS = 0x40,
    SG_RESULT = 0x41,
    COOLCONF = 0x42,
    MSCNT = 0x6A,
    CHOPCONF = 0x6C,
    DRV_STATUS = 0x6F,
    PWMCONF = 0x70,
};

static simulate_axis_t axis = {.step_gpio = STEP, .dir_gpio = DIR};
static simulate_tmc_t chip;

static uint64_t now_ns(void) {
    return host_clock_now_ns();
}

static void put(unsigned address, uint32_t value) {
    simulate_tmc_write(&chip, address, value, now_ns());
}

static uint32_t get(unsigned address) {
    return simulate_tmc_read(&chip, address, now_ns());
}

static void wait_us(uint64_t us) {
    host_clock_run(now_ns() + us * 1000, false);
}

// As a user sets it up: 16 microsteps, 800 mA, StealthChop.
static void set_up(void) {
    put(GCONF, 0x1C0);
    put(IHOLD_IRUN, 0x81907);
    put(TPOWERDOWN, 20);
    put(CHOPCONF, 0x14030153);
    put(PWMCONF, 0xCF0D0E24);
    put(GSTAT, 7);
}

void setUp(void) {
    uint32_t load_ma = 80;
    hal_pin_output(STEP, false);
    hal_pin_output(DIR, true);
    hal_pin_output(ENABLE, false);
    wait_us(1000000); // it stands
    chip.faults = (simulate_faults_t){0};
    simulate_motor_init(&chip.motor, 0);
    chip.motor.load_ma = load_ma;
    chip.mscnt_0 = 0;
    simulate_tmc_reset(&chip, now_ns());
    axis.last_step_ns = 0;
    set_up();
}
void tearDown(void) {}

static void steps_every_ns(unsigned count, bool up, uint64_t every_ns) {
    (up ? hal_pins_set : hal_pins_clear)(1u << DIR);
    for (unsigned i = 0; i < count; i++) {
        host_clock_run(now_ns() + every_ns, false);
        hal_pins_set(1u << STEP);
        hal_pins_clear(1u << STEP);
    }
}

static void steps(unsigned count, bool up, unsigned every_us) {
    steps_every_ns(count, up, every_us * 1000u);
}

static bool diag_level(void) {
    return (hal_pins_read() >> DIAG & 1) != 0;
}

// ---- Registers ----------------------------------------------------------------------------------

static void test_reset_values(void) {
    simulate_tmc_reset(&chip, now_ns());
    TEST_ASSERT_EQUAL_HEX32(0x101, get(GCONF));
    TEST_ASSERT_EQUAL_HEX32(1, get(GSTAT));
    TEST_ASSERT_EQUAL_HEX32(0, get(IFCNT));
    TEST_ASSERT_EQUAL_HEX32(0x21000040, get(IOIN) & ~0x200u); // but DIR
    TEST_ASSERT_EQUAL_HEX32(0xFFFFF, get(TSTEP));
    TEST_ASSERT_EQUAL_HEX32(0, get(MSCNT));
    TEST_ASSERT_EQUAL_HEX32(0x10000053, get(CHOPCONF));
    TEST_ASSERT_EQUAL_HEX32(0xC10D0024, get(PWMCONF));
    TEST_ASSERT_EQUAL_HEX32(0xC01F0000, get(DRV_STATUS)); // stands, StealthChop, still at IRUN
    TEST_ASSERT_EQUAL_UINT32(8, simulate_tmc_microsteps(&chip));
}

static void test_gstat_is_cleared_by_ones(void) {
    simulate_tmc_reset(&chip, now_ns());
    put(GSTAT, 2);
    TEST_ASSERT_EQUAL_HEX32(1, get(GSTAT));
    put(GSTAT, 1);
    TEST_ASSERT_EQUAL_HEX32(0, get(GSTAT));
    TEST_ASSERT_EQUAL_UINT32(2, get(IFCNT));
}

static void test_bits_that_are_not_there_are_not_kept(void) {
    put(GCONF, UINT32_MAX);
    TEST_ASSERT_EQUAL_HEX32(0x3FF, get(GCONF));
    put(PWMCONF, UINT32_MAX);
    TEST_ASSERT_EQUAL_HEX32(0xFF3FFFFF, get(PWMCONF));
}

static void test_microsteps_by_pins_and_by_register(void) {
    static const unsigned of_2209[] = {8, 32, 64, 16};
    static const unsigned of_2208[] = {8, 2, 4, 16};
    for (unsigned resolution = 0; resolution <= 8; resolution++) {
        put(CHOPCONF, 0x10000053 | resolution << 24);
        TEST_ASSERT_EQUAL_UINT32(256u >> resolution, simulate_tmc_microsteps(&chip));
    }
    put(GCONF, 0x140);
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
    put(SGTHRS, 100);
    put(TCOOLTHRS, 100);
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, SGTHRS, now_ns()));
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, TCOOLTHRS, now_ns()));
    TEST_ASSERT_NULL(simulate_tmc_name(&chip, SG_RESULT));
    TEST_ASSERT_EQUAL_HEX32(0x20000140, get(IOIN) & ~0x200u);
    chip.chip = 2209;
}

// ---- Current ------------------------------------------------------------------------------------

// Worked out by hand: (CS + 1) / 32 * Vfs / (Rs + 20 mohm) / sqrt(2).
static void test_currents(void) {
    static const struct {
        uint32_t cs, vsense, ma;
    } cases[] = {{2, 1, 92}, {15, 1, 490}, {25, 1, 795}, {17, 0, 994}, {31, 0, 1768}};
    for (unsigned i = 0; i < COUNT_OF_ARRAY(cases); i++) {
        put(IHOLD_IRUN, cases[i].cs << 8);
        put(CHOPCONF, 0x14010153 | cases[i].vsense << 17);
        steps(1, true, 1000);
        TEST_ASSERT_UINT32_WITHIN(1, cases[i].ma, simulate_tmc_current_ma(&chip, now_ns()));
    }
}

static uint32_t current_scale(void) {
    return get(DRV_STATUS) >> 16 & 31;
}

// 20 and then 8 times 2^18 clocks of 12 MHz: 437 ms and 175 ms each.
static void test_at_a_standstill_the_current_goes_down(void) {
    steps(1, true, 100);
    wait_us(430000);
    TEST_ASSERT_EQUAL_UINT32(25, current_scale());
    wait_us(10000);
    TEST_ASSERT_EQUAL_UINT32(24, current_scale());
    wait_us(175000);
    TEST_ASSERT_EQUAL_UINT32(23, current_scale());
    wait_us(4000000);
    TEST_ASSERT_EQUAL_UINT32(7, current_scale());
    steps(1, true, 100);
    TEST_ASSERT_EQUAL_UINT32(25, current_scale());
}

static void test_coolstep_saves_current_and_gives_it_back(void) {
    put(TCOOLTHRS, 200);
    put(COOLCONF, 2 | 3u << 5 | 1u << 8 | 3u << 13); // up by 8, down at every measurement
    steps(16 * 40, true, 100);
    TEST_ASSERT_EQUAL_UINT32(12, current_scale()); // half of 25, as seimin says
    chip.motor.load_ma = 380;                      // nearly all that half gives
    steps(16 * 2, true, 100);
    TEST_ASSERT_GREATER_THAN_UINT32(16, current_scale());
    put(COOLCONF, 0);
    steps(16 * 2, true, 100);
    TEST_ASSERT_EQUAL_UINT32(25, current_scale());
}

// ---- Speed --------------------------------------------------------------------------------------

static void test_step_time(void) {
    steps(40, true, 100); // 1200 clocks for 16 of 256
    TEST_ASSERT_EQUAL_UINT32(75, get(TSTEP));
    wait_us(200);
    TEST_ASSERT_EQUAL_UINT32(150, get(TSTEP));
    TEST_ASSERT_EQUAL_HEX32(0, get(DRV_STATUS) >> 31);
    wait_us(87000);
    TEST_ASSERT_EQUAL_HEX32(0, get(DRV_STATUS) >> 31);
    wait_us(400);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFF, get(TSTEP));
    TEST_ASSERT_EQUAL_HEX32(1, get(DRV_STATUS) >> 31);
    put(CHOPCONF, 0x15030153); // 8 microsteps
    steps(40, true, 100);
    TEST_ASSERT_EQUAL_UINT32(37, get(TSTEP));
}

static void test_step_time_is_a_mean(void) {
    for (unsigned i = 0; i < 20; i++) {
        steps(1, true, 70);
        steps(1, true, 80);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 56, get(TSTEP));
}

static void test_mscnt_counts_with_the_field(void) {
    steps(3, true, 100);
    TEST_ASSERT_EQUAL_UINT32(48, get(MSCNT));
    steps(4, false, 100);
    TEST_ASSERT_EQUAL_UINT32(1008, get(MSCNT));
    put(GCONF, 0x1C8); // shaft
    steps(1, false, 100);
    TEST_ASSERT_EQUAL_UINT32(0, get(MSCNT));
    steps(3200, false, 100);
    TEST_ASSERT_INT64_WITHIN(1, 3200, axis.position_steps);
}

static uint32_t mean_load(unsigned every_us) {
    uint32_t sum = 0;
    steps(160, true, every_us);
    for (unsigned i = 0; i < 90; i++) {
        steps(16, true, every_us);
        sum += get(SG_RESULT);
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
    put(GCONF, 0x1C4); // SpreadCycle
    TEST_ASSERT_EQUAL_UINT32(0, mean_load(50));
}

// ---- The stall output ---------------------------------------------------------------------------

static void arm(void) {
    put(SGTHRS, 120);
    put(TCOOLTHRS, 200);
}

static void test_a_stall_shows_within_two_full_steps(void) {
    arm();
    chip.motor.stop_high = 100 * 256;
    steps(16 * 100, true, 100);
    TEST_ASSERT_FALSE(diag_level());
    unsigned until = 0;
    while (!diag_level() && until < 100) {
        steps(1, true, 100);
        until++;
    }
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(32, until);
    for (unsigned i = 0; i < 300; i++) {
        steps(1, true, 100);
        TEST_ASSERT_TRUE(diag_level()); // it does not recover in between
    }
    TEST_ASSERT_EQUAL_UINT32(0, get(SG_RESULT));
    TEST_ASSERT_EQUAL_HEX32(0x10, get(IOIN) & 0x10);
}

// 201 step times behind the last pulse, and not at the next event of something else.
static void test_diag_falls_when_the_pulses_end(void) {
    arm();
    chip.motor.stop_high = 1000;
    steps(200, true, 100);
    TEST_ASSERT_TRUE(diag_level());
    wait_us(260);
    TEST_ASSERT_TRUE(diag_level());
    wait_us(10);
    TEST_ASSERT_FALSE(diag_level());
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
        put(SGTHRS, cases[i].sgthrs);
        put(TCOOLTHRS, cases[i].tcoolthrs);
        put(TPWMTHRS, cases[i].tpwmthrs);
        put(GCONF, cases[i].gconf);
        chip.motor.stop_high = 1000;
        steps(400, true, 100);
        char number[2] = {(char)('0' + i), '\0'};
        TEST_ASSERT_EQUAL_MESSAGE(cases[i].diag, diag_level(), number);
        chip.motor.stop_high = SIMULATE_MOTOR_NO_END;
    }
}

static void test_a_higher_threshold_is_more_sensitive(void) {
    put(TCOOLTHRS, 200);
    put(SGTHRS, 120);
    steps(800, true, 100);
    TEST_ASSERT_FALSE(diag_level());
    chip.motor.load_ma = 600;
    steps(80, true, 100);
    TEST_ASSERT_TRUE(diag_level());
    put(SGTHRS, 20);
    steps(80, true, 100);
    TEST_ASSERT_FALSE(diag_level());
}

// ---- Faults -------------------------------------------------------------------------------------

static void set_fault(simulate_chip_fault_t fault, int32_t value, unsigned in_us) {
    simulate_faults_set(&chip.faults, fault, now_ns() + in_us * 1000u, UINT64_MAX);
    simulate_faults_limit(&chip.faults, fault, value);
}

static void test_brown_out_forgets_and_moves_otherwise(void) {
    arm();
    steps(40, true, 100);
    int64_t before = axis.position_steps;
    set_fault(SIMULATE_CHIP_BROWN_OUT, 0, 500);
    wait_us(499);
    TEST_ASSERT_EQUAL_UINT32(8, get(IFCNT));
    wait_us(2);
    TEST_ASSERT_EQUAL_UINT32(0, get(IFCNT));
    TEST_ASSERT_EQUAL_UINT32(1, get(GSTAT));
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_register(&chip, TCOOLTHRS, now_ns()));
    TEST_ASSERT_EQUAL_UINT32(0, get(MSCNT)); // the rotor jumps there
    TEST_ASSERT_INT64_WITHIN(32, before, axis.position_steps);
    before = axis.position_steps;
    steps(100, true, 100);
    TEST_ASSERT_INT64_WITHIN(1, before + 200, axis.position_steps); // 8 instead of 16
    put(GSTAT, 1);
    wait_us(1000);
    TEST_ASSERT_EQUAL_UINT32(0, get(GSTAT)); // it happens once
}

static void test_temperatures(void) {
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 119, 0);
    TEST_ASSERT_EQUAL_HEX32(0, get(DRV_STATUS) & 0xFFF);
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 130, 0);
    TEST_ASSERT_EQUAL_HEX32(0x101, get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_FALSE(diag_level()); // a warning is only told
    TEST_ASSERT_EQUAL_HEX32(0, get(GSTAT));
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 145, 0);
    TEST_ASSERT_EQUAL_HEX32(0x303, get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_EQUAL_HEX32(2, get(GSTAT));
    TEST_ASSERT_TRUE(diag_level());
    TEST_ASSERT_EQUAL_UINT32(0, simulate_tmc_current_ma(&chip, now_ns()));
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 125, 0); // stays off until the warning is over
    TEST_ASSERT_EQUAL_HEX32(0x103, get(DRV_STATUS) & 0xFFF);
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 100, 0);
    TEST_ASSERT_EQUAL_HEX32(0, get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_TRUE(diag_level()); // the error is kept
    put(GSTAT, 2);
    TEST_ASSERT_FALSE(diag_level());
    put(FACTORY_CONF, 3u << 8);
    set_fault(SIMULATE_CHIP_OVER_TEMPERATURE, 150, 0);
    TEST_ASSERT_EQUAL_HEX32(0x701, get(DRV_STATUS) & 0xFFF);
}

// Without anybody asking, at its time.
static void test_a_short_raises_diag_by_itself(void) {
    set_fault(SIMULATE_CHIP_SHORT, 0, 700);
    wait_us(699);
    TEST_ASSERT_FALSE(diag_level());
    wait_us(2);
    TEST_ASSERT_TRUE(diag_level());
    TEST_ASSERT_EQUAL_HEX32(4, get(DRV_STATUS) & 0xFFF);
    put(GSTAT, 7);
    TEST_ASSERT_EQUAL_HEX32(2, get(GSTAT)); // it is still there
    simulate_faults_clear(&chip.faults, SIMULATE_CHIP_SHORT);
    put(GSTAT, 7);
    TEST_ASSERT_FALSE(diag_level());
    set_fault(SIMULATE_CHIP_OPEN_LOAD, 0, 0);
    TEST_ASSERT_EQUAL_HEX32(0x40, get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_FALSE(diag_level());
}

static void test_faults_that_pass(void) {
    simulate_faults_set(&chip.faults, SIMULATE_CHIP_OVER_TEMPERATURE, now_ns() + 1000000,
                        now_ns() + 2000000);
    simulate_faults_limit(&chip.faults, SIMULATE_CHIP_OVER_TEMPERATURE, 160);
    wait_us(1500);
    TEST_ASSERT_TRUE(diag_level());
    wait_us(1000);
    TEST_ASSERT_EQUAL_HEX32(0, get(DRV_STATUS) & 0xFFF);
    TEST_ASSERT_EQUAL_HEX32(2, get(GSTAT));
    simulate_faults_set(&chip.faults, SIMULATE_CHIP_UNPOWERED, now_ns(), now_ns() + 1000000);
    wait_us(500);
    int64_t before = axis.position_steps;
    steps(4, true, 100);
    TEST_ASSERT_EQUAL_INT64(before, axis.position_steps);
    wait_us(500);
    TEST_ASSERT_EQUAL_HEX32(1, get(GSTAT)); // all is lost when it comes back
    TEST_ASSERT_EQUAL_UINT32(8, simulate_tmc_microsteps(&chip));
}

static void test_an_obstacle_at_a_place_from_a_time_on(void) {
    arm();
    set_fault(SIMULATE_CHIP_STALL, 60, 10000);
    steps(70, true, 100);
    TEST_ASSERT_INT64_WITHIN(2, 70, axis.position_steps);
    steps(70, false, 100);
    wait_us(1000);
    steps(200, true, 100);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(60, axis.position_steps);
    TEST_ASSERT_TRUE(diag_level());
    TEST_ASSERT_GREATER_THAN_UINT64(0, chip.motor.slips);
}

static void test_switched_off_the_motor_does_not_move(void) {
    steps(20, true, 100);
    int64_t before = axis.position_steps;
    hal_pins_set(1u << ENABLE);
    steps(128, true, 100);
    TEST_ASSERT_EQUAL_INT64(before, axis.position_steps);
    TEST_ASSERT_EQUAL_HEX32(1, get(IOIN) & 1);
    hal_pins_clear(1u << ENABLE);
    steps(64, true, 100);
    TEST_ASSERT_INT64_WITHIN(1, before + 64, axis.position_steps);
}

static void test_the_place_of_the_axis_is_that_of_the_rotor(void) {
    put(CHOPCONF, 0x12030153); // 64 microsteps; places count 16
    chip.motor.load_ma = 0;
    steps(400, true, 100);
    TEST_ASSERT_EQUAL_INT64(100, axis.position_steps);
    steps(802, false, 100);
    TEST_ASSERT_EQUAL_INT64(-100, axis.position_steps); // -100.5
    steps(1, false, 100);
    TEST_ASSERT_EQUAL_INT64(-101, axis.position_steps);
}

int main(void) {
    UNITY_BEGIN();
    simulate_tmc_init(&chip);
    chip.axis = &axis;
    chip.diag_gpio = DIAG;
    chip.enable_gpio = ENABLE;
    TEST_ASSERT_TRUE(simulate_axis_attach(&axis));
    TEST_ASSERT_TRUE(simulate_tmc_attach(&chip));
    hal_pin_input(DIAG, HAL_PULL_NONE);
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
