// TMC22xx CURRENT, SGTHRS, TCOOLTHRS, STALL, COOLSTEP, STEALTH. Context: main loop.
#include "basic_cmds/tmc_tune.h"

#include "basic_cmds/report.h"
#include "basic_cmds/tmc.h"
#include "stepper/stepper_check.h"
#include "tmc22xx/tmc22xx_registers.h"

err_t tmc_tune_current(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    err_t err = tmc_begin(&args[0], &args[3], &driver);
    if (err == ERR_OK) {
        double hold_percent = args[2].given ? args[2].number : -1.0;
        err = tmc_finish(tmc22xx_set_current(driver, args[1].number, hold_percent));
    }
    if (err == ERR_OK) {
        tmc_warn_of_current(driver);
    }
    return err;
}

static err_t set_threshold(const basic_arg_t *args, uint8_t reg) {
    unsigned driver;
    err_t err = tmc_begin(&args[0], &args[2], &driver);
    if (err == ERR_OK) {
        err = tmc_finish(tmc22xx_begin_write(driver, reg, (uint32_t)args[1].integer));
    }
    return err;
}

err_t tmc_tune_sgthrs(const basic_arg_t *args, size_t count) {
    (void)count;
    return set_threshold(args, TMC22XX_REG_SGTHRS);
}

err_t tmc_tune_tcoolthrs(const basic_arg_t *args, size_t count) {
    (void)count;
    return set_threshold(args, TMC22XX_REG_TCOOLTHRS);
}

// ---- Speeds of an axis --------------------------------------------------------------------------

// The driver's axis, TMC22XX_NO_AXIS: none.
static unsigned axis_of(unsigned driver) {
    tmc22xx_info_t info;
    return tmc22xx_info(driver, &info) ? info.axis : TMC22XX_NO_AXIS;
}

// TSTEP at a feed of the driver's axis, 0 for none. Errors: no axis that is configured; faster than
// it can go.
static err_t tstep_at(unsigned driver, double feed, uint32_t *tstep) {
    unsigned axis = axis_of(driver);
    if (axis == TMC22XX_NO_AXIS) {
        return err_raise(ERR_TMC_NO_AXIS, NULL);
    }
    err_t err = stepper_check_axis((axis_id_t)axis);
    if (err == ERR_OK) {
        err = tmc_check_feed(axis, feed);
    }
    if (err == ERR_OK) {
        *tstep = feed > 0.0 ? tmc_tstep(driver, feed) : 0;
    }
    return err;
}

// The speed at a TSTEP, in units of the axis if there is one.
static void print_speed(unsigned driver, uint32_t tstep) {
    double steps_per_s = tmc22xx_steps_per_s(tstep, tmc22xx_driver(driver)->microsteps);
    unsigned axis = axis_of(driver);
    if (axis != TMC22XX_NO_AXIS && stepper_axis_configured((axis_id_t)axis)) {
        stepper_axis_t config;
        stepper_axis_config((axis_id_t)axis, &config);
        basic_printf("%.6g %s/min", steps_per_s * 60.0 / config.steps_per_unit,
                     report_unit((axis_id_t)axis));
    } else {
        basic_printf("%.6g steps/s", steps_per_s);
    }
}

// ---- Stalls -------------------------------------------------------------------------------------

static void tell_stall(unsigned driver, uint32_t tstep, bool always) {
    const tmc22xx_settings_t *settings = tmc22xx_driver(driver);
    tmc22xx_info_t info;
    if (settings == NULL || !tmc22xx_info(driver, &info)) {
        return; // closed meanwhile
    }
    if (tstep == 0) {
        basic_printf(always ? "TCOOLTHRS 0: no stalls are told\n"
                            : "Homing chooses TCOOLTHRS by itself\n");
        return;
    }
    basic_printf("TCOOLTHRS %u%s: stalls are told from ", (unsigned)tstep,
                 always ? "" : " while homing");
    print_speed(driver, tstep);
    basic_printf(" up\n");
    if (!settings->stealth) {
        basic_printf("Warning: StallGuard needs StealthChop (TMC22xx STEALTH)\n");
    } else if (info.tpwmthrs >= tstep) {
        basic_printf("Warning: TPWMTHRS %u ends StealthChop, which StallGuard needs, before that\n",
                     (unsigned)info.tpwmthrs);
    }
    if (info.sgthrs == 0) {
        basic_printf("Warning: SGTHRS is 0, so no stall is told (TMC22xx SGTHRS)\n");
    }
}

err_t tmc_tune_stall(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    uint32_t tstep = 0;
    bool always = args[2].integer != 0;
    err_t err = tmc_begin(&args[0], &args[3], &driver);
    if (err == ERR_OK && tmc22xx_driver(driver)->chip != 2209) {
        err = err_raise(ERR_TMC_NO_STALLGUARD, NULL);
    }
    err = err != ERR_OK ? err : tstep_at(driver, args[1].number, &tstep);
    if (err == ERR_OK && always) {
        err = tmc_finish(tmc22xx_begin_write(driver, TMC22XX_REG_TCOOLTHRS, tstep));
    }
    if (err == ERR_OK) {
        tmc22xx_keep_threshold(driver, tstep, true);
        tell_stall(driver, tstep, always);
    }
    return err;
}

// ---- CoolStep, StealthChop ----------------------------------------------------------------------

err_t tmc_tune_coolstep(const basic_arg_t *args, size_t count) {
    (void)count;
    const tmc22xx_coolstep_t coolstep = {
        .semin = (uint8_t)args[1].integer,
        .semax = (uint8_t)args[2].integer,
        .seup = (uint8_t)args[3].integer,
        .sedn = (uint8_t)args[4].integer,
        .seimin = (uint8_t)args[5].integer,
    };
    unsigned driver;
    tmc22xx_info_t info;
    err_t err = tmc_begin(&args[0], &args[6], &driver);
    if (err == ERR_OK) {
        err = tmc_finish(tmc22xx_set_coolstep(driver, &coolstep));
    }
    if (err == ERR_OK && coolstep.semin > 0 && tmc22xx_info(driver, &info) && info.tcoolthrs == 0) {
        basic_printf("Warning: CoolStep works while TSTEP is at or below TCOOLTHRS, which is 0\n");
    }
    return err;
}

static err_t stealth_threshold(const basic_arg_t *args, unsigned driver, uint32_t *tpwmthrs) {
    const basic_arg_t *threshold = &args[1];
    const basic_arg_t *feed = &args[2];
    if (threshold->given && feed->given) {
        return err_raise(ERR_ARGUMENT, "threshold, feed: only one of them can be given");
    }
    *tpwmthrs = threshold->text.length > 0 ? 0 : (uint32_t)threshold->integer;
    return feed->given ? tstep_at(driver, feed->number, tpwmthrs) : ERR_OK;
}

err_t tmc_tune_stealth(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    uint32_t tpwmthrs = 0;
    bool on = args[1].text.length == 0; // else it is OFF
    err_t err = tmc_begin(&args[0], &args[3], &driver);
    err = err != ERR_OK ? err : stealth_threshold(args, driver, &tpwmthrs);
    if (err == ERR_OK) {
        err = tmc_finish(tmc22xx_set_stealth(driver, on, tpwmthrs));
    }
    if (err != ERR_OK) {
        return err;
    }
    if (on && tpwmthrs != 0) {
        basic_printf("TPWMTHRS %u: StealthChop up to ", (unsigned)tpwmthrs);
        print_speed(driver, tpwmthrs);
        basic_printf(", SpreadCycle above\n");
    } else {
        basic_printf("%s at all speeds\n", on ? "StealthChop" : "SpreadCycle");
    }
    return ERR_OK;
}
