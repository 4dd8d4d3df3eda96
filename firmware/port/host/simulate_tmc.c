// The registers of the simulated driver, and its life. Context: any.
#include "simulate_tmc.h"

#include <string.h>

#include "hal/hal.h"
#include "host_clock.h"
#include "host_pads.h"
#include "simulate_tmc_state.h"

enum { READ = 1, WRITE = 2, CLEAR = 4, ONLY_2209 = 8 };

// What the registers can hold, and what they hold at reset.
static const struct {
    uint8_t address;
    uint8_t access;
    uint32_t mask;
    uint32_t reset;
    const char *name;
} chip_registers[] = {
    {TMC_GCONF, READ | WRITE, 0x3FF, 0x101, "GCONF"},
    {TMC_GSTAT, READ | CLEAR, 0x7, TMC_GSTAT_RESET, "GSTAT"},
    {TMC_IFCNT, READ, 0xFF, 0, "IFCNT"},
    {TMC_SLAVECONF, WRITE, 0xF00, 0, "SLAVECONF"},
    {0x04, WRITE, 0xFFFF, 0, "OTP_PROG"},
    {0x05, READ, 0xFFFFFF, 0x0E, "OTP_READ"},
    {TMC_IOIN, READ, 0xFF0003FF, 0, "IOIN"},
    {TMC_FACTORY_CONF, READ | WRITE, 0x31F, 0x0E, "FACTORY_CONF"},
    {TMC_IHOLD_IRUN, WRITE, 0xF1F1F, 0x11F10, "IHOLD_IRUN"},
    {TMC_TPOWERDOWN, WRITE, 0xFF, 20, "TPOWERDOWN"},
    {TMC_TSTEP, READ, TMC_TSTEP_MAX, 0, "TSTEP"},
    {TMC_TPWMTHRS, WRITE, 0xFFFFF, 0, "TPWMTHRS"},
    {TMC_TCOOLTHRS, WRITE | ONLY_2209, 0xFFFFF, 0, "TCOOLTHRS"},
    {0x22, WRITE, 0xFFFFFF, 0, "VACTUAL"},
    {TMC_SGTHRS, WRITE | ONLY_2209, 0xFF, 0, "SGTHRS"},
    {TMC_SG_RESULT, READ | ONLY_2209, 0x3FF, 0, "SG_RESULT"},
    {TMC_COOLCONF, WRITE | ONLY_2209, 0xFFFF, 0, "COOLCONF"},
    {TMC_MSCNT, READ, 0x3FF, 0, "MSCNT"},
    {TMC_MSCURACT, READ, 0x1FF01FF, 0, "MSCURACT"},
    {TMC_CHOPCONF, READ | WRITE, 0xFF0387FF, 0x10000053, "CHOPCONF"},
    {TMC_DRV_STATUS, READ, 0xC01F0FFF, 0, "DRV_STATUS"},
    {TMC_PWMCONF, READ | WRITE, 0xFF3FFFFF, 0xC10D0024, "PWMCONF"},
    {TMC_PWM_SCALE, READ, 0x1FF00FF, 0, "PWM_SCALE"},
    {TMC_PWM_AUTO, READ, 0xFF00FF, 0, "PWM_AUTO"},
};

#define REGISTER_COUNT (sizeof chip_registers / sizeof chip_registers[0])

static struct {
    simulate_tmc_t *list[SIMULATE_TMC_MAX];
    unsigned count;
} drivers;

// Its index; REGISTER_COUNT if there is none.
static unsigned find(const simulate_tmc_t *tmc, unsigned address) {
    unsigned i = 0;
    while (i < REGISTER_COUNT && chip_registers[i].address != address) {
        i++;
    }
    bool missing =
        i < REGISTER_COUNT && tmc->chip != 2209 && (chip_registers[i].access & ONLY_2209) != 0;
    return missing ? REGISTER_COUNT : i;
}

const char *simulate_tmc_name(const simulate_tmc_t *tmc, unsigned address) {
    unsigned i = find(tmc, address);
    return i < REGISTER_COUNT ? chip_registers[i].name : NULL;
}

// ---- Reading and writing ------------------------------------------------------------------------

// The part of StealthChop: what it has found, which is what it was told, and the scale.
static uint32_t pwm_auto(const simulate_tmc_t *tmc) {
    uint32_t setting = tmc->registers[TMC_PWMCONF];
    return tmc_bits(setting, 8, 8) << 16 | tmc_bits(setting, 0, 8);
}

uint32_t simulate_tmc_register(simulate_tmc_t *tmc, unsigned address, uint64_t now_ns) {
    switch (address) {
    case TMC_IOIN:
        return simulate_tmc_state_ioin(tmc);
    case TMC_TSTEP:
        return simulate_tmc_state_tstep(tmc, now_ns);
    case TMC_SG_RESULT:
        return tmc->chip == 2209 ? tmc->sg_result : 0;
    case TMC_MSCNT:
        return simulate_tmc_state_mscnt(tmc);
    case TMC_MSCURACT:
        return simulate_tmc_state_mscuract(tmc);
    case TMC_DRV_STATUS:
        return simulate_tmc_state_drv_status(tmc, now_ns);
    case TMC_PWM_SCALE:
        return simulate_tmc_state_current_scale(tmc, now_ns) * 255 / 31;
    case TMC_PWM_AUTO:
        return pwm_auto(tmc);
    default:
        return address < SIMULATE_TMC_REGISTERS ? tmc->registers[address] : 0;
    }
}

uint32_t simulate_tmc_read(simulate_tmc_t *tmc, unsigned address, uint64_t now_ns) {
    simulate_tmc_update(tmc, now_ns);
    unsigned i = find(tmc, address);
    bool readable = i < REGISTER_COUNT && (chip_registers[i].access & READ) != 0;
    return readable ? simulate_tmc_register(tmc, address, now_ns) : 0;
}

void simulate_tmc_write(simulate_tmc_t *tmc, unsigned address, uint32_t value, uint64_t now_ns) {
    simulate_tmc_update(tmc, now_ns);
    unsigned i = find(tmc, address);
    uint32_t microsteps = simulate_tmc_microsteps(tmc);
    if (i < REGISTER_COUNT && (chip_registers[i].access & WRITE) != 0) {
        tmc->registers[address] = value & chip_registers[i].mask;
    } else if (i < REGISTER_COUNT && (chip_registers[i].access & CLEAR) != 0) {
        tmc->registers[address] &= ~value;
    }
    tmc->registers[TMC_IFCNT] = (tmc->registers[TMC_IFCNT] + 1) & 0xFF;
    if (simulate_tmc_microsteps(tmc) != microsteps) {
        simulate_tmc_state_forget(tmc);
    }
    simulate_tmc_update(tmc, now_ns);
}

uint32_t simulate_tmc_microsteps(const simulate_tmc_t *tmc) {
    static const uint8_t by_pins_2209[] = {8, 32, 64, 16};
    static const uint8_t by_pins_2208[] = {8, 2, 4, 16};
    if ((tmc->registers[TMC_GCONF] & TMC_GCONF_MSTEP_REG) == 0) {
        return (tmc->chip == 2209 ? by_pins_2209 : by_pins_2208)[tmc->address & 3];
    }
    uint32_t resolution = tmc_bits(tmc->registers[TMC_CHOPCONF], 24, 4);
    return resolution < 8 ? 256u >> resolution : 1;
}

// ---- Its life -----------------------------------------------------------------------------------

void simulate_tmc_reset(simulate_tmc_t *tmc, uint64_t now_ns) {
    memset(tmc->registers, 0, sizeof tmc->registers);
    for (unsigned i = 0; i < REGISTER_COUNT; i++) {
        tmc->registers[chip_registers[i].address] = chip_registers[i].reset;
    }
    tmc->reset_ns = now_ns;
    tmc->too_hot = false;
    tmc->sg_result = 0;
    tmc->coolstep_down = 0;
    simulate_tmc_state_forget(tmc);
    simulate_motor_jump(&tmc->motor, tmc->mscnt_0, simulate_tmc_current_ma(tmc, now_ns));
}

// Places of the axis and of the motor.
static int64_t to_motor(const simulate_tmc_t *tmc, int64_t steps) {
    return steps * (int64_t)(256 / tmc->microsteps);
}

static void report_position(const simulate_tmc_t *tmc) {
    int64_t unit = (int64_t)(256 / tmc->microsteps);
    int64_t middle = tmc->motor.rotor + unit / 2;
    int64_t rest = middle % unit;
    tmc->axis->position_steps = (middle - rest) / unit - (rest < 0 ? 1 : 0);
}

static void block(simulate_tmc_t *tmc, int64_t place) {
    if (tmc->motor.rotor >= place && tmc->motor.stop_low < place) {
        tmc->motor.stop_low = place;
    } else if (tmc->motor.rotor < place && tmc->motor.stop_high > place) {
        tmc->motor.stop_high = place;
    }
}

// The ends of the axis, without an obstacle.
static void unblock(simulate_tmc_t *tmc) {
    bool has_stops = tmc->axis != NULL && tmc->axis->has_stops;
    tmc->motor.stop_low = -SIMULATE_MOTOR_NO_END;
    tmc->motor.stop_high = SIMULATE_MOTOR_NO_END;
    if (has_stops) {
        tmc->motor.stop_low = to_motor(tmc, tmc->axis->stop_low_steps);
        tmc->motor.stop_high = to_motor(tmc, tmc->axis->stop_high_steps);
    }
}

// Takes notice of faults that have come or gone.
static void look_at_faults(simulate_tmc_t *tmc, uint64_t now_ns) {
    for (unsigned i = 0; i < SIMULATE_CHIP_FAULTS; i++) {
        simulate_faults_change_t change =
            simulate_faults_change(&tmc->faults, (simulate_chip_fault_t)i, now_ns);
        bool begins = change == SIMULATE_FAULTS_BEGINS;
        if (change == SIMULATE_FAULTS_STAYS) {
            continue;
        }
        if (i == (begins ? SIMULATE_CHIP_BROWN_OUT : SIMULATE_CHIP_UNPOWERED)) {
            simulate_tmc_reset(tmc, now_ns);
        } else if (i == SIMULATE_CHIP_STALL && begins) {
            block(tmc, to_motor(tmc, tmc->faults.list[i].value));
        } else if (i == SIMULATE_CHIP_STALL) {
            unblock(tmc);
        }
    }
}

void simulate_tmc_update(simulate_tmc_t *tmc, uint64_t now_ns) {
    look_at_faults(tmc, now_ns);
    simulate_tmc_state_heat(tmc, now_ns);
    if (tmc->too_hot || simulate_faults_active(&tmc->faults, SIMULATE_CHIP_SHORT, now_ns)) {
        tmc->registers[TMC_GSTAT] |= TMC_GSTAT_DRV_ERR;
    }
    simulate_motor_turn(&tmc->motor, 0, simulate_tmc_current_ma(tmc, now_ns));
    if (tmc->axis != NULL) {
        report_position(tmc);
    }
    bool diag = (tmc->registers[TMC_GSTAT] & TMC_GSTAT_DRV_ERR) != 0 ||
                simulate_tmc_state_stalled(tmc, now_ns);
    if (diag != tmc->diag && tmc->diag_gpio != PINS_NONE) {
        host_pads_drive(tmc->diag_gpio, diag);
    }
    tmc->diag = diag;
    tmc->calm_ns = simulate_tmc_state_calm_ns(tmc, now_ns);
}

// ---- All of them --------------------------------------------------------------------------------

void simulate_tmc_init(simulate_tmc_t *tmc) {
    memset(tmc, 0, sizeof *tmc);
    tmc->chip = 2209;
    tmc->tx_gpio = PINS_NONE;
    tmc->rx_gpio = PINS_NONE;
    tmc->diag_gpio = PINS_NONE;
    tmc->enable_gpio = PINS_NONE;
    tmc->microsteps = 16;
    tmc->sense_mohm = 110;
    tmc->clock_khz = 12000;
}

bool simulate_tmc_attach(simulate_tmc_t *tmc) {
    if (drivers.count == SIMULATE_TMC_MAX) {
        return false;
    }
    drivers.list[drivers.count++] = tmc;
    simulate_motor_init(&tmc->motor, 0);
    tmc->motor.load_ma = tmc->load_ma;
    if (tmc->axis != NULL) {
        simulate_motor_init(&tmc->motor, to_motor(tmc, tmc->axis->position_steps));
        tmc->motor.load_ma = tmc->load_ma;
        tmc->axis->mover = simulate_tmc_state_step;
        tmc->axis->mover_state = tmc;
    }
    unblock(tmc);
    tmc->mscnt_0 = tmc->motor.rotor;
    if (tmc->diag_gpio != PINS_NONE) {
        host_pads_drive(tmc->diag_gpio, false);
    }
    simulate_tmc_reset(tmc, host_clock_now_ns());
    simulate_tmc_update(tmc, host_clock_now_ns());
    return true;
}

simulate_tmc_t *simulate_tmc_at(unsigned index) {
    return index < drivers.count ? drivers.list[index] : NULL;
}

uint64_t simulate_tmc_next_ns(void) {
    uint64_t next_ns = UINT64_MAX;
    for (unsigned i = 0; i < drivers.count; i++) {
        uint64_t fault_ns = simulate_faults_next_ns(&drivers.list[i]->faults);
        uint64_t calm_ns = drivers.list[i]->calm_ns;
        uint64_t mine_ns = fault_ns < calm_ns ? fault_ns : calm_ns;
        next_ns = mine_ns < next_ns ? mine_ns : next_ns;
    }
    return next_ns;
}

void simulate_tmc_run(uint64_t now_ns) {
    for (unsigned i = 0; i < drivers.count; i++) {
        simulate_tmc_update(drivers.list[i], now_ns);
    }
}
