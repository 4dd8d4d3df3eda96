// A simulated driver with a motor and all its pins, for the unit tests of what it does.
#ifndef TESTS_HOST_CHIP_H
#define TESTS_HOST_CHIP_H

#include <stdbool.h>
#include <stdint.h>

#include "simulate_tmc.h"

#define CHIP_STEP 2u
#define CHIP_DIR 3u
#define CHIP_DIAG 10u
#define CHIP_ENABLE 4u

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

extern simulate_tmc_t chip;
extern simulate_axis_t chip_axis;

// Connects it, once.
void chip_attach(void);

// Set up with 16 microsteps, 800 mA, StealthChop; it has stood for a second, without faults.
void chip_renew(void);

// Its registers, as the wire sees them.
void chip_put(unsigned address, uint32_t value);
uint32_t chip_get(unsigned address);

uint64_t chip_now_ns(void);
void chip_wait_us(uint64_t us);

// Step pulses, so far apart.
void chip_steps(unsigned count, bool up, unsigned every_us);
void chip_steps_every_ns(unsigned count, bool up, uint64_t every_ns);

bool chip_diag(void);

#endif
