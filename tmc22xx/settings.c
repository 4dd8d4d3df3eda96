// Settings to registers and back. Context: main loop.
#include "tmc22xx/settings.h"

#include "tmc22xx/tmc22xx_registers.h"

// Sense voltage at full scale, and the resistance inside the chip that adds to the sense resistor.
#define FULL_SCALE_MV 325.0
#define LOW_SCALE_MV 180.0
#define INNER_OHM 0.02
#define SQUARE_ROOT_OF_2 1.41421356

#define SCALES 32
#define SCALE_MAX 31
#define SCALE_MIN_OF_HIGH_RANGE 16 // below it the low range is finer

// What a set-up writes besides the settings.
#define HOLD_DELAY 8  // 175 ms for each step down
#define POWER_DOWN 20 // 437 ms

static double full_scale_mv(bool vsense) {
    return vsense ? LOW_SCALE_MV : FULL_SCALE_MV;
}

double tmc22xx_scale_ma(unsigned scale, bool vsense, double r_sense_ohm) {
    return (scale + 1) * full_scale_mv(vsense) /
           (SCALES * SQUARE_ROOT_OF_2 * (r_sense_ohm + INNER_OHM));
}

// The scale whose current is nearest, as a number that is not yet cut to a whole one.
static double wanted_scale(double ma, bool vsense, double r_sense_ohm) {
    return SCALES * SQUARE_ROOT_OF_2 * ma * (r_sense_ohm + INNER_OHM) / full_scale_mv(vsense) - 0.5;
}

err_t tmc22xx_current(double ma, double r_sense_ohm, tmc22xx_current_t *current) {
    bool vsense = wanted_scale(ma, false, r_sense_ohm) < SCALE_MIN_OF_HIGH_RANGE;
    double wanted = wanted_scale(ma, vsense, r_sense_ohm);
    if (!(wanted >= 0.0)) {
        return err_raise(ERR_TMC_CURRENT, "%.3g mA is too little (the least is %.3g mA)", ma,
                         tmc22xx_scale_ma(0, true, r_sense_ohm));
    }
    bool limited = wanted >= SCALES;
    current->scale = limited ? SCALE_MAX : (uint8_t)wanted;
    current->vsense = vsense;
    current->limited = limited;
    current->real_ma = tmc22xx_scale_ma(current->scale, vsense, r_sense_ohm);
    return ERR_OK;
}

uint32_t tmc22xx_ihold_irun(const tmc22xx_current_t *current, double hold_percent) {
    uint32_t hold = (uint32_t)(current->scale * hold_percent / 100.0);
    return TMC22XX_BITS(IHOLD_IRUN, IHOLD, hold) | TMC22XX_BITS(IHOLD_IRUN, IRUN, current->scale) |
           TMC22XX_BITS(IHOLD_IRUN, IHOLDDELAY, HOLD_DELAY);
}

int tmc22xx_mres(unsigned microsteps) {
    for (int mres = 0; mres <= 8; mres++) {
        if (microsteps == tmc22xx_microsteps((unsigned)mres)) {
            return mres;
        }
    }
    return -1;
}

unsigned tmc22xx_microsteps(unsigned mres) {
    return mres <= 8 ? 256u >> mres : 0;
}

uint32_t tmc22xx_tstep(double steps_per_s, unsigned microsteps) {
    double clocks = TMC22XX_CLOCK_HZ * (double)microsteps / (256.0 * steps_per_s);
    if (!(clocks < (double)TMC22XX_TSTEP_MAX)) { // also 0 steps/s
        return TMC22XX_TSTEP_MAX;
    }
    uint32_t rounded = (uint32_t)(clocks + 0.5);
    return rounded > 0 ? rounded : 1;
}

double tmc22xx_steps_per_s(uint32_t tstep, unsigned microsteps) {
    if (tstep >= TMC22XX_TSTEP_MAX) {
        return 0.0;
    }
    return TMC22XX_CLOCK_HZ * (double)microsteps / (256.0 * (tstep > 0 ? tstep : 1));
}

static err_t check(const tmc22xx_settings_t *settings) {
    unsigned chip = tmc22xx_chip_bit(settings->chip);
    unsigned highest = chip == TMC22XX_2208 ? 0 : 3;
    if (chip == 0) {
        return err_raise(ERR_TMC_CHIP, NULL);
    }
    if (settings->address > highest) {
        return err_raise(ERR_TMC_ADDRESS, "%u: a TMC%u has address 0%s", settings->address,
                         settings->chip, highest == 0 ? "" : " to 3");
    }
    if (tmc22xx_mres(settings->microsteps) < 0) {
        return err_raise(ERR_TMC_MICROSTEPS, NULL);
    }
    if (!(settings->hold_percent >= 0.0 && settings->hold_percent <= 100.0)) {
        return err_raise(ERR_ARGUMENT, "hold_pct must be 0 to 100");
    }
    if (!(settings->r_sense_ohm >= TMC22XX_R_SENSE_MIN_OHM &&
          settings->r_sense_ohm <= TMC22XX_R_SENSE_MAX_OHM)) {
        return err_raise(ERR_ARGUMENT, "r_sense must be 0.08 to 0.2");
    }
    return ERR_OK;
}

static uint32_t gconf(bool stealth) {
    return TMC22XX_BITS(GCONF, en_SpreadCycle, !stealth) | TMC22XX_BITS(GCONF, pdn_disable, 1) |
           TMC22XX_BITS(GCONF, mstep_reg_select, 1) | TMC22XX_BITS(GCONF, multistep_filt, 1);
}

static uint32_t chopconf(bool vsense, unsigned microsteps) {
    return TMC22XX_BITS(CHOPCONF, TOFF, 3) | TMC22XX_BITS(CHOPCONF, HSTRT, 5) |
           TMC22XX_BITS(CHOPCONF, HEND, 2) | TMC22XX_BITS(CHOPCONF, TBL, 2) |
           TMC22XX_BITS(CHOPCONF, vsense, vsense) |
           TMC22XX_BITS(CHOPCONF, MRES, tmc22xx_mres(microsteps)) |
           TMC22XX_BITS(CHOPCONF, intpol, 1);
}

static uint32_t pwmconf(void) {
    return TMC22XX_BITS(PWMCONF, PWM_OFS, 36) | TMC22XX_BITS(PWMCONF, PWM_GRAD, 14) |
           TMC22XX_BITS(PWMCONF, pwm_freq, 1) | TMC22XX_BITS(PWMCONF, pwm_autoscale, 1) |
           TMC22XX_BITS(PWMCONF, pwm_autograd, 1) | TMC22XX_BITS(PWMCONF, PWM_REG, 15) |
           TMC22XX_BITS(PWMCONF, PWM_LIM, 12);
}

err_t tmc22xx_setup_writes(const tmc22xx_settings_t *settings,
                           tmc22xx_write_t writes[TMC22XX_SETUP_WRITES]) {
    err_t err = check(settings);
    tmc22xx_current_t run;
    if (err == ERR_OK) {
        err = tmc22xx_current(settings->run_ma, settings->r_sense_ohm, &run);
    }
    if (err != ERR_OK) {
        return err;
    }
    writes[0] = (tmc22xx_write_t){TMC22XX_REG_GCONF, gconf(settings->stealth)};
    writes[1] =
        (tmc22xx_write_t){TMC22XX_REG_IHOLD_IRUN, tmc22xx_ihold_irun(&run, settings->hold_percent)};
    writes[2] = (tmc22xx_write_t){TMC22XX_REG_TPOWERDOWN, POWER_DOWN};
    writes[3] = (tmc22xx_write_t){TMC22XX_REG_CHOPCONF, chopconf(run.vsense, settings->microsteps)};
    writes[4] = (tmc22xx_write_t){TMC22XX_REG_PWMCONF, pwmconf()};
    return ERR_OK;
}
