// TMC22xx SGTUNE: the axis of a driver makes a jog, and SG_RESULT is read as often as the wire lets
// it be. What it is at constant speed becomes a proposal for SGTHRS and TCOOLTHRS, which is shown
// and not applied. Context: main loop.
#include "basic_cmds/tmc_sgtune.h"

#include <math.h>

#include "basic_cmds/job.h"
#include "basic_cmds/report.h"
#include "basic_cmds/tmc.h"
#include "basic_cmds/tmc_homing.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_homing.h"
#include "tmc22xx/tmc22xx_registers.h"

#define ROW_US 50000u
// Of constant speed, before readings count; and so many full steps, since each brings one.
#define SETTLE_US 50000.0
#define SETTLE_FULL_STEPS 4.0
#define READINGS_MIN 10u     // at constant speed; from less nothing is concluded
#define HELD_READINGS 30u    // of 0 one after another at constant speed: the axis is held
#define CONSTANT_PART 0.98   // of the highest speed so far: that counts as constant
#define FASTER_PART 1.01     // and this as a new highest one
#define DISTANCE_SECONDS 1.0 // at the feed, if no distance is given

// A stall is to be told when SG_RESULT has fallen to two thirds of its lowest value in free
// running. That is at SG_RESULT <= 2 * SGTHRS, so SGTHRS is a third of it. The third that is left
// above is for load, for wear, and for a motor that is cold or hot.
#define SGTHRS_DIVISOR 3u
#define SGTHRS_MAX 255u
// Below this the difference to a stall, which is near 0, is lost in the noise of single readings.
#define LOWEST_USABLE 30u
#define SEEK_DIFFERS 0.1 // of the feed: homing at another one gives other values

typedef struct {
    unsigned count;
    uint32_t sum, lowest; // of SG_RESULT
} readings_t;

typedef struct {
    unsigned driver;
    axis_id_t axis;
    double full_step;          // in units of the axis
    uint64_t begin_us, row_us; // of the jog, of this row
    uint64_t constant_us;      // since when the speed is constant
    double top;                // highest speed so far but for a percent, units/min
    double fastest;            // of those that counted as constant
    double speed;              // and the last one
    uint32_t sg_result, cs;    // the last ones
    readings_t row, constant;  // of this row; at constant speed
    unsigned zeros;            // the last ones that were 0 at constant speed
} tune_t;

// To the last step.
static bool moves(void) {
    stepper_status_t status;
    stepper_status(&status);
    return status.jogging || status.stopping || status.moving;
}

// ---- Before anything moves ----------------------------------------------------------------------

// The driver and its axis.
static err_t take_driver(tune_t *tune) {
    const tmc22xx_settings_t *settings = tmc22xx_driver(tune->driver);
    tmc22xx_info_t info;
    if (!tmc22xx_info(tune->driver, &info) || info.axis == TMC22XX_NO_AXIS) {
        return err_raise(ERR_TMC_NO_AXIS, NULL);
    }
    if (settings->chip != 2209) {
        return err_raise(ERR_TMC_NO_STALLGUARD, NULL);
    }
    if (!info.listens) {
        return err_raise(ERR_TMC_SGTUNE, "the driver is not listened to (TMC22xx VERIFY)");
    }
    tune->axis = (axis_id_t)info.axis;
    stepper_axis_t config;
    err_t err = stepper_check_axis(tune->axis);
    if (err == ERR_OK) {
        stepper_axis_config(tune->axis, &config);
        tune->full_step = settings->microsteps / config.steps_per_unit;
    }
    return err;
}

static err_t prepare(tune_t *tune, const basic_arg_t *args) {
    err_t err = tmc_begin(&args[SGTUNE_DRIVER], &args[SGTUNE_TX_PIN], &tune->driver);
    if (err == ERR_OK) {
        err = take_driver(tune);
    }
    if (err == ERR_OK) {
        err = tmc_check_feed(tune->axis, args[SGTUNE_FEED].number);
    }
    if (err == ERR_OK && !tmc_is_stealthy(tune->driver, args[SGTUNE_FEED].number)) {
        err = err_raise(ERR_TMC_SGTUNE,
                        "StallGuard needs StealthChop at this feed (TMC22xx STEALTH)");
    }
    if (err == ERR_OK) {
        err = job_check_free();
    }
    if (err == ERR_OK) {
        err = rules_check(RULES_DO_JOG);
    }
    stepper_status_t status;
    stepper_status(&status);
    return err == ERR_OK && status.jogging ? err_raise(ERR_JOGGING, NULL) : err;
}

// ---- While it moves -----------------------------------------------------------------------------

static void note(readings_t *readings, uint32_t sg_result) {
    readings->lowest =
        readings->count == 0 || sg_result < readings->lowest ? sg_result : readings->lowest;
    readings->sum += sg_result;
    readings->count++;
}

static double mean(const readings_t *readings) {
    return (double)readings->sum / (double)readings->count;
}

static void note_constant(tune_t *tune, double speed) {
    uint64_t now_us = hal_time_us();
    if (speed > FASTER_PART * tune->top) {
        tune->top = speed;
        tune->constant_us = now_us;
        tune->fastest = 0.0;
        tune->constant.count = 0;
        tune->constant.sum = 0;
    }
    double settle_us = SETTLE_US + SETTLE_FULL_STEPS * tune->full_step / speed * 60e6;
    if (speed >= CONSTANT_PART * tune->top && (double)(now_us - tune->constant_us) >= settle_us) {
        tune->fastest = fmax(tune->fastest, speed);
        note(&tune->constant, tune->sg_result);
        tune->zeros = tune->sg_result == 0 ? tune->zeros + 1 : 0;
    }
}

static void print_row(tune_t *tune) {
    uint64_t now_us = hal_time_us();
    if (now_us - tune->row_us < ROW_US) {
        return;
    }
    basic_printf("%13lu %8.0f %9.0f %6lu %3lu\n", (unsigned long)((now_us - tune->begin_us) / 1000),
                 tune->speed, mean(&tune->row), (unsigned long)tune->row.lowest,
                 (unsigned long)tune->cs);
    tune->row = (readings_t){0};
    tune->row_us = now_us;
}

static err_t read_driver(tune_t *tune) {
    static const uint8_t registers[] = {TMC22XX_REG_SG_RESULT, TMC22XX_REG_DRV_STATUS};
    err_t err = tmc_await_turn();
    if (err == ERR_OK) {
        err = tmc_finish(tmc22xx_begin_read(tune->driver, registers, COUNT_OF_ARRAY(registers)));
    }
    if (err == ERR_OK) {
        tune->sg_result = TMC22XX_TAKE(tmc22xx_value(0), SG_RESULT, SG_RESULT);
        tune->cs = TMC22XX_TAKE(tmc22xx_value(1), DRV_STATUS, CS_ACTUAL);
    }
    return err;
}

// The speed while the driver was read is at least the lower one of before and behind.
static err_t take_reading(tune_t *tune) {
    double before = stepper_speed();
    err_t err = read_driver(tune);
    if (err == ERR_OK) {
        tune->speed = stepper_speed();
        note(&tune->row, tune->sg_result);
        note_constant(tune, fmin(before, tune->speed));
        print_row(tune);
    }
    if (tune->zeros == HELD_READINGS) {
        stepper_jog_stop(); // nothing more can be learned by hammering
    }
    return err;
}

// A driver that does not answer ends the jog as well; Ctrl-C has done so by itself.
static err_t measure(tune_t *tune) {
    err_t err = ERR_OK;
    tune->begin_us = tune->row_us = hal_time_us();
    basic_printf("SGTUNE     ms %6s/min SG_RESULT lowest  CS\n", report_unit(tune->axis));
    while (err == ERR_OK && moves()) {
        err = take_reading(tune);
    }
    if (err != ERR_OK) {
        err_kept_t kept;
        err_keep(&kept);
        stepper_jog_stop();
        err_put_back(&kept);
    }
    return err == ERR_OK ? rules_check(RULES_DO_JOG) : err; // what has stopped it at once
}

// ---- What follows from it -----------------------------------------------------------------------

static err_t check_readings(const tune_t *tune) {
    if (tune->constant.count < READINGS_MIN) {
        return err_raise(ERR_TMC_SGTUNE, "the axis had no constant speed for long enough: more "
                                         "distance or a lower feed");
    }
    if (tune->constant.lowest < LOWEST_USABLE) {
        return err_raise(ERR_TMC_SGTUNE,
                         "SG_RESULT fell to %u in free running, a stall would look the same: more "
                         "feed, another current; or the axis was held (home it then)",
                         (unsigned)tune->constant.lowest);
    }
    return ERR_OK;
}

// The axis's letter, if that means this driver.
static void print_command(const tune_t *tune, const char *command, double value) {
    unsigned found;
    const tmc22xx_settings_t *settings = tmc22xx_driver(tune->driver);
    bool by_axis = tmc22xx_find_axis(tune->axis, &found) == ERR_OK && found == tune->driver;
    if (by_axis) {
        basic_printf("TMC22xx %s %c,%.0f\n", command, STEPPER_AXIS_LETTERS[tune->axis], value);
    } else {
        const char *more = command[1] == 'T' ? ",0" : ""; // STALL has one argument more
        basic_printf("TMC22xx %s %u,%.0f%s,GP%u\n", command, settings->address, value, more,
                     settings->tx_gpio);
    }
}

static void hint_at_seek(const tune_t *tune) {
    stepper_home_t home;
    if (tune->axis >= STEPPER_HOME_AXES) {
        return;
    }
    stepper_home_settings(tune->axis, &home);
    if (fabs(home.seek - tune->fastest) > SEEK_DIFFERS * tune->fastest) {
        basic_printf("Homing goes at %.6g mm/min: tune at that feed, or home at this one\n",
                     home.seek);
    }
}

static void propose(const tune_t *tune) {
    const readings_t *constant = &tune->constant;
    const char *unit = report_unit(tune->axis);
    uint32_t sgthrs = constant->lowest / SGTHRS_DIVISOR;
    sgthrs = sgthrs > SGTHRS_MAX ? SGTHRS_MAX : sgthrs;
    double feed = round(TMC_HOMING_FEED_PART * tune->fastest);
    basic_printf("At %.0f %s/min: SG_RESULT %u lowest, %.0f mean of %u readings\n", tune->fastest,
                 unit, (unsigned)constant->lowest, mean(constant), constant->count);
    basic_printf("Proposal: a stall is SG_RESULT at or below %u, from %.0f %s/min on (TCOOLTHRS "
                 "%u)\n",
                 (unsigned)(2 * sgthrs), feed, unit, (unsigned)tmc_tstep(tune->driver, feed));
    print_command(tune, "SGTHRS", sgthrs);
    print_command(tune, "STALL", feed);
    hint_at_seek(tune);
}

err_t tmc_sgtune(const basic_arg_t *args, size_t count) {
    (void)count;
    tune_t tune = {0};
    double feed = args[SGTUNE_FEED].number;
    double distance =
        args[SGTUNE_DISTANCE].given ? args[SGTUNE_DISTANCE].number : feed / 60.0 * DISTANCE_SECONDS;
    err_t err = prepare(&tune, args);
    if (err == ERR_OK) {
        err = stepper_jog(tune.axis, distance, feed);
    }
    if (err == ERR_OK) {
        err = measure(&tune);
    }
    if (err == ERR_OK) {
        err = check_readings(&tune);
    }
    if (err == ERR_OK) {
        propose(&tune);
    }
    return err;
}
