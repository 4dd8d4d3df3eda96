// TMC22xx STATUS: what a driver was set to, and what it says about itself. Context: main loop.
#include "basic_cmds/tmc_status.h"

#include "basic_cmds/report.h"
#include "basic_cmds/tmc.h"
#include "tmc22xx/tmc22xx_registers.h"

// What is read, in the order in which the values come. A TMC2208 lacks the last one.
enum { READ_GSTAT, READ_IOIN, READ_DRV_STATUS, READ_IFCNT, READ_TSTEP, READ_SG_RESULT, READS };
static const uint8_t registers[READS] = {
    [READ_GSTAT] = TMC22XX_REG_GSTAT,           [READ_IOIN] = TMC22XX_REG_IOIN,
    [READ_DRV_STATUS] = TMC22XX_REG_DRV_STATUS, [READ_IFCNT] = TMC22XX_REG_IFCNT,
    [READ_TSTEP] = TMC22XX_REG_TSTEP,           [READ_SG_RESULT] = TMC22XX_REG_SG_RESULT,
};
_Static_assert((int)READS <= (int)TMC22XX_READS, "too much for one job");

// ---- Settings -----------------------------------------------------------------------------------

static void print_name(const tmc22xx_settings_t *settings, const tmc22xx_info_t *info) {
    basic_printf("TMC%u, address %u on %s", settings->chip, settings->address,
                 pins_name(settings->tx_gpio));
    if (info->rx_gpio != settings->tx_gpio) {
        basic_printf(", listens on %s", pins_name(info->rx_gpio));
    }
    if (info->baud != TMC22XX_BAUD) {
        basic_printf(", %u bit/s", (unsigned)info->baud);
    }
    if (info->axis != TMC22XX_NO_AXIS) {
        basic_printf(", %c axis", STEPPER_AXIS_LETTERS[info->axis]);
    }
    basic_printf("\n");
}

static void print_settings(const tmc22xx_settings_t *settings, const tmc22xx_info_t *info) {
    basic_printf("  set to: %.0f mA (CS %u, vsense %d), at standstill %.0f mA (CS %u), %u "
                 "microsteps, %s\n",
                 info->run_ma, info->irun, info->vsense, info->hold_ma, info->ihold,
                 settings->microsteps, settings->stealth ? "StealthChop" : "SpreadCycle");
    basic_printf("  thresholds: TPWMTHRS %u", (unsigned)info->tpwmthrs);
    if (settings->chip == 2209) {
        basic_printf(", TCOOLTHRS %u, SGTHRS %u", (unsigned)info->tcoolthrs, info->sgthrs);
    }
    if (info->kept_tcoolthrs != 0) {
        basic_printf("; for homing TCOOLTHRS %u", (unsigned)info->kept_tcoolthrs);
    }
    basic_printf("%s\n", info->armed ? ", ARMED" : "");
}

// ---- What it says -------------------------------------------------------------------------------

// All conditions of the severities from `least` to `most`, or `none`.
static void print_conditions(const uint32_t values[READS], int least, int most, const char *none) {
    static const uint8_t looked_at[] = {READ_GSTAT, READ_DRV_STATUS, READ_IOIN};
    bool any = false;
    for (size_t n = 0; n < COUNT_OF_ARRAY(looked_at); n++) {
        unsigned which = looked_at[n];
        uint32_t holding = tmc22xx_conditions_of(registers[which], values[which]);
        for (size_t i = 0; i < tmc22xx_condition_count; i++) {
            int severity = tmc22xx_conditions[i].severity;
            if (((holding >> i) & 1) != 0 && severity >= least && severity <= most) {
                basic_printf("%s%s", any ? ", " : "", tmc22xx_conditions[i].text);
                any = true;
            }
        }
    }
    basic_printf("%s\n", any ? "" : none);
}

static void print_load(const tmc22xx_settings_t *settings, const tmc22xx_info_t *info,
                       const uint32_t values[READS]) {
    unsigned scale = TMC22XX_TAKE(values[READ_DRV_STATUS], DRV_STATUS, CS_ACTUAL);
    basic_printf("  motor: CS %u (%.0f mA), TSTEP %u", scale,
                 tmc22xx_scale_ma(scale, info->vsense, settings->r_sense_ohm),
                 (unsigned)values[READ_TSTEP]);
    if (settings->chip == 2209) {
        basic_printf(", SG_RESULT %u", (unsigned)values[READ_SG_RESULT]);
    }
    basic_printf("\n");
}

static void print_values(const tmc22xx_settings_t *settings, const tmc22xx_info_t *info,
                         const uint32_t values[READS]) {
    unsigned degrees = tmc22xx_temperature(values[READ_DRV_STATUS]);
    basic_printf("  state: ");
    print_conditions(values, TMC22XX_STATE, TMC22XX_STATE, "");
    basic_printf("  faults: ");
    print_conditions(values, TMC22XX_HINT, TMC22XX_FAULT, "none");
    print_load(settings, info, values);
    basic_printf("  temperature: %s %u degrees Celsius\n", degrees == 0 ? "below" : "above",
                 degrees == 0 ? 120 : degrees);
    basic_printf("  wire: IFCNT %u, repeated frames %u, failed accesses %u\n",
                 (unsigned)values[READ_IFCNT], info->repeats, info->failures);
}

// ---- The drivers --------------------------------------------------------------------------------

// Error: it does not answer.
static err_t print_driver(unsigned driver) {
    tmc22xx_info_t info;
    uint32_t values[READS] = {0};
    if (!tmc22xx_info(driver, &info)) {
        return ERR_OK;
    }
    const tmc22xx_settings_t settings = *tmc22xx_driver(driver);
    print_name(&settings, &info);
    print_settings(&settings, &info);
    if (!info.listens) {
        basic_printf("  it is not asked: it was set up with TMC22xx VERIFY 0\n");
        return ERR_OK;
    }
    size_t count = settings.chip == 2209 ? READS : READ_SG_RESULT;
    err_t err = tmc_await_turn();
    err = err != ERR_OK ? err : tmc_finish(tmc22xx_begin_read(driver, registers, count));
    if (err != ERR_OK) {
        return err;
    }
    for (unsigned i = 0; i < count; i++) {
        values[i] = tmc22xx_value(i);
    }
    tmc22xx_info(driver, &info); // its counters have changed
    print_values(&settings, &info, values);
    return ERR_OK;
}

// One that does not answer is told in its place, and the others are still asked.
static err_t print_all(void) {
    unsigned count = 0;
    for (unsigned driver = 0; driver < TMC22XX_DRIVERS && !basic_break_pending(); driver++) {
        count += tmc22xx_driver(driver) != NULL;
        if (print_driver(driver) != ERR_OK) {
            basic_printf("  %s\n", err_message());
        }
    }
    basic_printf("%sverification is %s, monitor is %s\n",
                 count == 0 ? "TMC22xx not initialized; " : "", report_on_off(tmc22xx_verifies()),
                 report_on_off(tmc22xx_monitors()));
    return ERR_OK;
}

err_t tmc_status(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    if (!args[0].given) {
        return print_all();
    }
    err_t err = tmc_begin(&args[0], &args[1], &driver);
    return err != ERR_OK ? err : print_driver(driver);
}
