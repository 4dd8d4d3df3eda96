// Speed, load, current and temperature as the chip sees them; the step input. Context: any.
#include "simulate_tmc_state.h"

#include <math.h>
#include <string.h>

#include "hal/hal.h"
#include "host_clock.h"

#define STANDSTILL_CLOCKS (1u << 20)
#define DELAY_CLOCKS (1u << 18) // unit of TPOWERDOWN and IHOLDDELAY
#define ROOM_C 40               // of a chip that is well

static uint64_t clocks_ns(const simulate_tmc_t *tmc, uint64_t clocks) {
    return clocks * 1000000u / tmc->clock_khz;
}

// ---- Speed --------------------------------------------------------------------------------------

static uint64_t pulse_back_ns(const simulate_tmc_t *tmc, unsigned back) {
    unsigned size = SIMULATE_TMC_INTERVALS + 1;
    return tmc->pulse_ns[(tmc->pulse_next + size - 1 - back) % size];
}

static void note_pulse(simulate_tmc_t *tmc, uint64_t time_ns) {
    unsigned size = SIMULATE_TMC_INTERVALS + 1;
    if (tmc->pulses > 0 && time_ns - pulse_back_ns(tmc, 0) >= clocks_ns(tmc, STANDSTILL_CLOCKS)) {
        tmc->pulses = 0;
    }
    tmc->pulse_ns[tmc->pulse_next] = time_ns;
    tmc->pulse_next = (tmc->pulse_next + 1) % size;
    tmc->pulses += tmc->pulses < size ? 1 : 0;
}

void simulate_tmc_state_forget(simulate_tmc_t *tmc) {
    tmc->pulses = 0;
}

uint32_t simulate_tmc_state_tstep(const simulate_tmc_t *tmc, uint64_t now_ns) {
    if (tmc->pulses < 2) {
        return TMC_TSTEP_MAX;
    }
    uint64_t newest_ns = pulse_back_ns(tmc, 0);
    uint64_t mean_ns = (newest_ns - pulse_back_ns(tmc, tmc->pulses - 1)) / (tmc->pulses - 1);
    uint64_t since_ns = now_ns - newest_ns;
    if (since_ns >= clocks_ns(tmc, STANDSTILL_CLOCKS)) {
        return TMC_TSTEP_MAX;
    }
    uint64_t gap_ns = since_ns > mean_ns ? since_ns : mean_ns;
    uint64_t tstep = gap_ns * tmc->clock_khz * simulate_tmc_microsteps(tmc) / (1000000u * 256u);
    return tstep < TMC_TSTEP_MAX ? (uint32_t)tstep : TMC_TSTEP_MAX;
}

static bool is_standing(const simulate_tmc_t *tmc, uint64_t now_ns) {
    return tmc->pulses == 0 || now_ns - pulse_back_ns(tmc, 0) >= clocks_ns(tmc, STANDSTILL_CLOCKS);
}

static bool is_stealth(const simulate_tmc_t *tmc, uint64_t now_ns) {
    uint32_t threshold = tmc->registers[TMC_TPWMTHRS];
    return (tmc->registers[TMC_GCONF] & TMC_GCONF_SPREAD) == 0 &&
           (threshold == 0 || simulate_tmc_state_tstep(tmc, now_ns) >= threshold);
}

// Fast enough for StallGuard and CoolStep, and in the right mode.
static bool is_load_measured(const simulate_tmc_t *tmc, uint64_t now_ns) {
    uint32_t tstep = simulate_tmc_state_tstep(tmc, now_ns);
    return tmc->chip == 2209 && is_stealth(tmc, now_ns) && tmc->registers[TMC_TCOOLTHRS] >= tstep &&
           tstep > tmc->registers[TMC_TPWMTHRS];
}

bool simulate_tmc_state_stalled(const simulate_tmc_t *tmc, uint64_t now_ns) {
    return is_load_measured(tmc, now_ns) && tmc->sg_result <= 2 * tmc->registers[TMC_SGTHRS];
}

uint64_t simulate_tmc_state_calm_ns(const simulate_tmc_t *tmc, uint64_t now_ns) {
    if (tmc->pulses < 2 || !simulate_tmc_state_stalled(tmc, now_ns)) {
        return HOST_CLOCK_NEVER;
    }
    uint64_t clocks = (uint64_t)(tmc->registers[TMC_TCOOLTHRS] + 1) * 256;
    uint64_t calm_ns =
        pulse_back_ns(tmc, 0) + clocks_ns(tmc, clocks) / simulate_tmc_microsteps(tmc) + 1000;
    uint64_t still_ns = pulse_back_ns(tmc, 0) + clocks_ns(tmc, STANDSTILL_CLOCKS) + 1000;
    calm_ns = calm_ns < still_ns ? calm_ns : still_ns;
    return calm_ns > now_ns ? calm_ns : HOST_CLOCK_NEVER;
}

// ---- Current ------------------------------------------------------------------------------------

// The motor gets no current: switched off, too hot, shorted.
static bool is_off(const simulate_tmc_t *tmc, uint64_t now_ns) {
    bool disabled = (hal_pins_read() & pins_mask(tmc->enable_gpio)) != 0;
    return disabled || tmc->too_hot ||
           simulate_faults_active(&tmc->faults, SIMULATE_CHIP_UNPOWERED, now_ns) ||
           tmc_bits(tmc->registers[TMC_CHOPCONF], 0, 4) == 0 ||
           simulate_faults_active(&tmc->faults, SIMULATE_CHIP_SHORT, now_ns);
}

// Behind the last pulse, or behind power-up.
static uint64_t standing_ns(const simulate_tmc_t *tmc, uint64_t now_ns) {
    uint64_t last_ns = tmc->axis != NULL ? tmc->axis->last_step_ns : 0;
    return now_ns - (last_ns > tmc->reset_ns ? last_ns : tmc->reset_ns);
}

uint32_t simulate_tmc_state_current_scale(const simulate_tmc_t *tmc, uint64_t now_ns) {
    uint32_t setting = tmc->registers[TMC_IHOLD_IRUN];
    uint32_t hold = tmc_bits(setting, 0, 5);
    uint32_t run = tmc_bits(setting, 8, 5);
    uint64_t step_ns = clocks_ns(tmc, (uint64_t)tmc_bits(setting, 16, 4) * DELAY_CLOCKS);
    uint64_t wait_ns = clocks_ns(tmc, (uint64_t)tmc->registers[TMC_TPOWERDOWN] * DELAY_CLOCKS);
    uint64_t stands_ns = standing_ns(tmc, now_ns);
    run -= tmc->coolstep_down < run ? tmc->coolstep_down : run;
    if (stands_ns < clocks_ns(tmc, STANDSTILL_CLOCKS) || stands_ns < wait_ns) {
        return run;
    }
    uint64_t steps = step_ns == 0 ? run : (stands_ns - wait_ns) / step_ns + 1;
    return hold >= run || steps >= run - hold ? hold : run - (uint32_t)steps;
}

uint32_t simulate_tmc_current_ma(const simulate_tmc_t *tmc, uint64_t now_ns) {
    if (is_off(tmc, now_ns)) {
        return 0;
    }
    bool sensitive = tmc_bits(tmc->registers[TMC_CHOPCONF], 17, 1) != 0;
    double peak_ma = (sensitive ? 180e3 : 325e3) / (double)(tmc->sense_mohm + 20);
    double part = (double)(simulate_tmc_state_current_scale(tmc, now_ns) + 1) / 32.0;
    return (uint32_t)lround(peak_ma * part / sqrt(2.0));
}

// ---- Load ---------------------------------------------------------------------------------------

static uint32_t measured_load(simulate_tmc_t *tmc, uint64_t now_ns) {
    uint32_t torque_1024 = simulate_motor_take_torque(&tmc->motor);
    if (!is_stealth(tmc, now_ns) || torque_1024 >= 1024) {
        return 0;
    }
    uint32_t tstep = simulate_tmc_state_tstep(tmc, now_ns);
    double speed = (double)tmc->clock_khz * 1000.0 / (256.0 * (double)(tstep > 0 ? tstep : 1));
    double ripple = 0.96 + 0.01 * (double)(tmc->full_steps * 7 % 9);
    double result = 510.0 * speed / (speed + 60.0) * (1024.0 - torque_1024) / 1024.0 * ripple;
    return result < 510.0 ? (uint32_t)result & ~1u : 510;
}

// One measurement: the current goes up at once where the load is high, down after some.
static void regulate(simulate_tmc_t *tmc, uint64_t now_ns) {
    static const uint8_t up[] = {1, 2, 4, 8};
    static const uint8_t down_every[] = {32, 8, 2, 1};
    uint32_t setting = tmc->registers[TMC_COOLCONF];
    uint32_t low = tmc_bits(setting, 0, 4) * 32;
    uint32_t high = low + (tmc_bits(setting, 8, 4) + 1) * 32;
    uint32_t run = tmc_bits(tmc->registers[TMC_IHOLD_IRUN], 8, 5);
    uint32_t most = run - (tmc_bits(setting, 15, 1) != 0 ? run / 4 : run / 2);
    if (low == 0 || !is_load_measured(tmc, now_ns)) {
        tmc->coolstep_down = 0;
    } else if (tmc->sg_result < low) {
        uint32_t step = up[tmc_bits(setting, 5, 2)];
        tmc->coolstep_down -= step < tmc->coolstep_down ? step : tmc->coolstep_down;
    } else if (tmc->sg_result >= high &&
               ++tmc->coolstep_count >= down_every[tmc_bits(setting, 13, 2)]) {
        tmc->coolstep_count = 0;
        tmc->coolstep_down += tmc->coolstep_down < most ? 1 : 0;
    }
}

// ---- The step input -----------------------------------------------------------------------------

uint32_t simulate_tmc_state_mscnt(const simulate_tmc_t *tmc) {
    int64_t phase = (tmc->motor.pole - tmc->mscnt_0) % SIMULATE_MOTOR_PERIOD;
    return (uint32_t)(phase < 0 ? phase + SIMULATE_MOTOR_PERIOD : phase);
}

void simulate_tmc_state_step(void *state, uint64_t time_ns, bool up) {
    simulate_tmc_t *tmc = state;
    int32_t way = 256 / (int32_t)simulate_tmc_microsteps(tmc);
    bool reversed = (tmc->registers[TMC_GCONF] & TMC_GCONF_SHAFT) != 0;
    uint32_t quarter = simulate_tmc_state_mscnt(tmc) / SIMULATE_MOTOR_FULL_STEP;
    note_pulse(tmc, time_ns);
    simulate_motor_turn(&tmc->motor, up == reversed ? -way : way,
                        simulate_tmc_current_ma(tmc, time_ns));
    if (simulate_tmc_state_mscnt(tmc) / SIMULATE_MOTOR_FULL_STEP != quarter) {
        tmc->full_steps++;
        tmc->sg_result = measured_load(tmc, time_ns);
        regulate(tmc, time_ns);
    }
    simulate_tmc_update(tmc, time_ns);
}

// ---- Temperature --------------------------------------------------------------------------------

static int32_t temperature_c(const simulate_tmc_t *tmc, uint64_t now_ns) {
    simulate_chip_fault_t hot = SIMULATE_CHIP_OVER_TEMPERATURE;
    return simulate_faults_active(&tmc->faults, hot, now_ns) ? tmc->faults.list[hot].value : ROOM_C;
}

// By OTTRIM: where the chip warns and where it switches off.
static int32_t warning_c(const simulate_tmc_t *tmc) {
    return tmc_bits(tmc->registers[TMC_FACTORY_CONF], 8, 2) < 2 ? 120 : 143;
}

static int32_t shutdown_c(const simulate_tmc_t *tmc) {
    static const uint8_t limits_c[] = {143, 150, 150, 157};
    return limits_c[tmc_bits(tmc->registers[TMC_FACTORY_CONF], 8, 2)];
}

void simulate_tmc_state_heat(simulate_tmc_t *tmc, uint64_t now_ns) {
    int32_t at_c = temperature_c(tmc, now_ns);
    tmc->too_hot = at_c >= shutdown_c(tmc) || (tmc->too_hot && at_c >= warning_c(tmc));
}

// ---- Registers ----------------------------------------------------------------------------------

uint32_t simulate_tmc_state_drv_status(const simulate_tmc_t *tmc, uint64_t now_ns) {
    static const uint8_t thresholds_c[] = {120, 143, 150, 157};
    int32_t at_c = temperature_c(tmc, now_ns);
    uint32_t status = tmc->too_hot ? 1u << 1 : 0;
    for (unsigned i = 0; i < sizeof thresholds_c; i++) {
        status |= at_c >= thresholds_c[i] ? 1u << (8 + i) : 0;
    }
    status |= at_c >= warning_c(tmc) ? 1u << 0 : 0;
    status |= simulate_faults_active(&tmc->faults, SIMULATE_CHIP_SHORT, now_ns) ? 1u << 2 : 0;
    status |= simulate_faults_active(&tmc->faults, SIMULATE_CHIP_OPEN_LOAD, now_ns) ? 1u << 6 : 0;
    status |= simulate_tmc_state_current_scale(tmc, now_ns) << 16;
    status |= is_stealth(tmc, now_ns) ? 1u << 30 : 0;
    return status | (is_standing(tmc, now_ns) ? 1u << 31 : 0);
}

uint32_t simulate_tmc_state_ioin(const simulate_tmc_t *tmc) {
    uint32_t pins = hal_pins_read();
    uint32_t step = tmc->axis != NULL ? pins_mask(tmc->axis->step_gpio) : 0;
    uint32_t dir = tmc->axis != NULL ? pins_mask(tmc->axis->dir_gpio) : 0;
    uint32_t value = (pins & pins_mask(tmc->enable_gpio)) != 0 ? 1u << 0 : 0;
    value |= tmc->address << 2; // MS1, MS2
    value |= tmc->diag ? 1u << 4 : 0;
    value |= 1u << 6; // the wire, idle
    value |= (pins & step) != 0 ? 1u << 7 : 0;
    value |= (pins & dir) != 0 ? 1u << 9 : 0;
    return value | (tmc->chip == 2209 ? 0x21u << 24 : 0x20u << 24 | 1u << 8);
}

uint32_t simulate_tmc_state_mscuract(const simulate_tmc_t *tmc) {
    double angle = 2.0 * 3.14159265358979323846 * (simulate_tmc_state_mscnt(tmc) + 0.5) / 1024.0;
    uint32_t a = (uint32_t)lround(248.0 * sin(angle)) & 0x1FF;
    uint32_t b = (uint32_t)lround(248.0 * cos(angle)) & 0x1FF;
    return b << 16 | a;
}
