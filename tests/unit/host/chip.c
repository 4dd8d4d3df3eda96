// The driver, as a user sets it up.
#include "chip.h"

#include <unity.h>

#include "hal/hal.h"
#include "host_clock.h"

simulate_axis_t chip_axis = {.step_gpio = CHIP_STEP, .dir_gpio = CHIP_DIR};
simulate_tmc_t chip;

uint64_t chip_now_ns(void) {
    return host_clock_now_ns();
}

void chip_put(unsigned address, uint32_t value) {
    simulate_tmc_write(&chip, address, value, chip_now_ns());
}

uint32_t chip_get(unsigned address) {
    return simulate_tmc_read(&chip, address, chip_now_ns());
}

void chip_wait_us(uint64_t us) {
    host_clock_run(chip_now_ns() + us * 1000, false);
}

// As a user sets it up: 16 microsteps, 800 mA, StealthChop.
static void set_up(void) {
    chip_put(GCONF, 0x1C0);
    chip_put(IHOLD_IRUN, 0x81907);
    chip_put(TPOWERDOWN, 20);
    chip_put(CHOPCONF, 0x14030153);
    chip_put(PWMCONF, 0xCF0D0E24);
    chip_put(GSTAT, 7);
}

void chip_attach(void) {
    simulate_tmc_init(&chip);
    chip.axis = &chip_axis;
    chip.diag_gpio = CHIP_DIAG;
    chip.enable_gpio = CHIP_ENABLE;
    TEST_ASSERT_TRUE(simulate_axis_attach(&chip_axis));
    TEST_ASSERT_TRUE(simulate_tmc_attach(&chip));
    hal_pin_input(CHIP_DIAG, HAL_PULL_NONE);
}

void chip_renew(void) {
    uint32_t load_ma = 80;
    hal_pin_output(CHIP_STEP, false);
    hal_pin_output(CHIP_DIR, true);
    hal_pin_output(CHIP_ENABLE, false);
    chip_wait_us(1000000); // it stands
    chip.faults = (simulate_faults_t){0};
    simulate_motor_init(&chip.motor, 0);
    chip.motor.load_ma = load_ma;
    chip.mscnt_0 = 0;
    simulate_tmc_reset(&chip, chip_now_ns());
    chip_axis.last_step_ns = 0;
    set_up();
}

void chip_steps_every_ns(unsigned count, bool up, uint64_t every_ns) {
    (up ? hal_pins_set : hal_pins_clear)(1u << CHIP_DIR);
    for (unsigned i = 0; i < count; i++) {
        host_clock_run(chip_now_ns() + every_ns, false);
        hal_pins_set(1u << CHIP_STEP);
        hal_pins_clear(1u << CHIP_STEP);
    }
}

void chip_steps(unsigned count, bool up, unsigned every_us) {
    chip_steps_every_ns(count, up, every_us * 1000u);
}

bool chip_diag(void) {
    return (hal_pins_read() >> CHIP_DIAG & 1) != 0;
}
