// What the chip finds out about itself and its motor: the values of the registers that no wire
// writes. For simulate_tmc.c. Context: any.
#ifndef SIMULATE_TMC_STATE_H
#define SIMULATE_TMC_STATE_H

#include "simulate_tmc.h"

// Addresses of the registers that do something.
enum {
    TMC_GCONF = 0x00,
    TMC_GSTAT = 0x01,
    TMC_IFCNT = 0x02,
    TMC_SLAVECONF = 0x03,
    TMC_IOIN = 0x06,
    TMC_FACTORY_CONF = 0x07,
    TMC_IHOLD_IRUN = 0x10,
    TMC_TPOWERDOWN = 0x11,
    TMC_TSTEP = 0x12,
    TMC_TPWMTHRS = 0x13,
    TMC_TCOOLTHRS = 0x14,
    TMC_SGTHRS = 0x40,
    TMC_SG_RESULT = 0x41,
    TMC_COOLCONF = 0x42,
    TMC_MSCNT = 0x6A,
    TMC_MSCURACT = 0x6B,
    TMC_CHOPCONF = 0x6C,
    TMC_DRV_STATUS = 0x6F,
    TMC_PWMCONF = 0x70,
    TMC_PWM_SCALE = 0x71,
    TMC_PWM_AUTO = 0x72,
};

// Bits of GCONF and GSTAT.
enum {
    TMC_GCONF_SPREAD = 1u << 2,
    TMC_GCONF_SHAFT = 1u << 3,
    TMC_GCONF_MSTEP_REG = 1u << 7,
    TMC_GSTAT_RESET = 1u << 0,
    TMC_GSTAT_DRV_ERR = 1u << 1,
};

#define TMC_TSTEP_MAX 0xFFFFFu

// Bits `low` and up of a word.
static inline uint32_t tmc_bits(uint32_t word, unsigned low, unsigned count) {
    return (word >> low) & ((1u << count) - 1);
}

// Values of registers.
uint32_t simulate_tmc_state_tstep(const simulate_tmc_t *tmc, uint64_t now_ns);
uint32_t simulate_tmc_state_current_scale(const simulate_tmc_t *tmc, uint64_t now_ns);
uint32_t simulate_tmc_state_drv_status(const simulate_tmc_t *tmc, uint64_t now_ns);
uint32_t simulate_tmc_state_ioin(const simulate_tmc_t *tmc);
uint32_t simulate_tmc_state_mscnt(const simulate_tmc_t *tmc);
uint32_t simulate_tmc_state_mscuract(const simulate_tmc_t *tmc);

// The stall output is on, by the thresholds.
bool simulate_tmc_state_stalled(const simulate_tmc_t *tmc, uint64_t now_ns);

// When a stall that is shown ends without another pulse, because the speed is too low by then;
// UINT64_MAX: nothing is shown.
uint64_t simulate_tmc_state_calm_ns(const simulate_tmc_t *tmc, uint64_t now_ns);

// Switches the motor off when it is too hot, and on when even the warning is over.
void simulate_tmc_state_heat(simulate_tmc_t *tmc, uint64_t now_ns);

// Forgets the pulses: a standstill, or another resolution.
void simulate_tmc_state_forget(simulate_tmc_t *tmc);

// A step pulse. The observer of the axis.
void simulate_tmc_state_step(void *state, uint64_t time_ns, bool up);

#endif
