// StallGuard around homing: the drivers tied to the axes of a group are armed for their approach,
// and disarmed behind it, so that a heavy cut cannot look like the end of an axis. Which drivers: a
// TMC2209 in StealthChop with a threshold SGTHRS; all others find no stall. Context: main loop.
#include "basic_cmds/tmc_homing.h"

#include "basic_cmds/control.h"
#include "basic_cmds/tmc.h"
#include "stepper/stepper_homing.h"

#define LOOK_US 1000u

static struct {
    bool begun;       // a job is under way that has begun
    bool to_on;       // with this
    uint32_t drivers; // that are armed, or are to be; a mask
} arming;

// ---- Which drivers ------------------------------------------------------------------------------

static bool is_of(unsigned driver, uint32_t axes, tmc22xx_info_t *info) {
    return tmc22xx_info(driver, info) && info->axis < STEPPER_HOME_AXES &&
           ((axes >> info->axis) & 1) != 0;
}

static bool finds_stalls(const tmc22xx_settings_t *settings, const tmc22xx_info_t *info) {
    return settings->chip == 2209 && settings->stealth && info->sgthrs > 0;
}

static err_t raise(const tmc22xx_info_t *info, const char *needs, double feed) {
    return err_raise(ERR_TMC_NOT_ARMED,
                     "%c needs TMC22xx %s at %.6g mm/min (a switch needs a latch feed: STEPPER "
                     "HOME)",
                     STEPPER_AXIS_LETTERS[info->axis], needs, feed);
}

// The speed from which on the user wants stalls to be told is above that of homing.
static err_t raise_too_slow(const tmc22xx_info_t *info, double feed) {
    return err_raise(ERR_TMC_NOT_ARMED,
                     "%c would not work at %.6g mm/min: TCOOLTHRS is for more (TMC22xx STALL)",
                     STEPPER_AXIS_LETTERS[info->axis], feed);
}

static err_t check_driver(unsigned driver, const tmc22xx_info_t *info) {
    const tmc22xx_settings_t *settings = tmc22xx_driver(driver);
    axis_id_t axis = (axis_id_t)info->axis;
    if (settings->chip != 2209 || !stepper_home_halts(axis)) {
        return ERR_OK;
    }
    stepper_home_t home;
    stepper_home_settings(axis, &home);
    uint32_t wanted = info->kept_tcoolthrs != 0 ? info->kept_tcoolthrs : info->tcoolthrs;
    if (!tmc_is_stealthy(driver, home.seek)) {
        return raise(info, "STEALTH", home.seek);
    }
    if (info->sgthrs == 0) {
        return raise(info, "SGTHRS", home.seek);
    }
    bool too_slow = wanted != 0 && tmc_tstep(driver, home.seek) > wanted;
    return too_slow ? raise_too_slow(info, home.seek) : ERR_OK;
}

// An axis that would run against its end without noticing is refused before anything moves.
static err_t check(uint32_t axes) {
    err_t err = ERR_OK;
    for (unsigned driver = 0; driver < TMC22XX_DRIVERS && err == ERR_OK; driver++) {
        tmc22xx_info_t info;
        if (is_of(driver, axes, &info)) {
            err = check_driver(driver, &info);
        }
    }
    return err;
}

// Of the first approach: SG_RESULT is smaller at a lower speed, so what fits the seek feed would
// take a slow second one for a stall right away.
static uint32_t homing_tstep(unsigned driver, unsigned axis) {
    stepper_home_t home;
    stepper_home_settings((axis_id_t)axis, &home);
    return tmc_tstep(driver, TMC_HOMING_FEED_PART * home.seek);
}

// The drivers to be armed, each with a threshold.
static uint32_t choose(uint32_t axes) {
    uint32_t drivers = 0;
    for (unsigned driver = 0; driver < TMC22XX_DRIVERS; driver++) {
        tmc22xx_info_t info;
        if (is_of(driver, axes, &info) && finds_stalls(tmc22xx_driver(driver), &info)) {
            tmc22xx_keep_threshold(driver, homing_tstep(driver, info.axis), false);
            drivers |= 1u << driver;
        }
    }
    return drivers;
}

// Those that are armed, or may be.
static uint32_t armed(void) {
    uint32_t drivers = 0;
    for (unsigned driver = 0; driver < TMC22XX_DRIVERS; driver++) {
        tmc22xx_info_t info;
        drivers |= tmc22xx_info(driver, &info) && info.armed ? 1u << driver : 0;
    }
    return drivers;
}

// ---- The hook -----------------------------------------------------------------------------------

static stepper_arm_t begin(uint32_t axes, bool on) {
    arming.drivers = on ? choose(axes) : arming.drivers & armed();
    if (arming.drivers == 0) {
        return STEPPER_ARM_DONE;
    }
    err_t err = tmc22xx_begin_arm(arming.drivers, on);
    arming.begun = err == ERR_OK;
    arming.to_on = on;
    return err == ERR_OK || err == ERR_TMC_BUSY ? STEPPER_ARM_BUSY : STEPPER_ARM_FAILED;
}

// A stop may want the opposite before the job has come to its end.
static stepper_arm_t take_on(uint32_t axes, bool on) {
    if (!arming.begun) {
        return begin(axes, on);
    }
    if (tmc22xx_arm_busy()) {
        return STEPPER_ARM_BUSY;
    }
    arming.begun = false;
    if (arming.to_on != on) {
        return begin(axes, on);
    }
    arming.drivers = on ? arming.drivers : 0;
    err_t err = tmc22xx_arm_result();
    if (err == ERR_OK) {
        return STEPPER_ARM_DONE;
    }
    if (!on && err != ERR_TMC_LOST) { // that has switched StallGuard off, too
        err_kept_t why;
        err_keep(&why);
        err_raise(ERR_TMC_STILL_ARMED, "%s", why.text);
    }
    return STEPPER_ARM_FAILED;
}

static stepper_arm_t arm(uint32_t axes, bool on) {
    if (stepper_cycle() != STEPPER_CYCLE_NONE) {
        return take_on(axes, on);
    }
    err_kept_t kept; // the statement in the foreground may be about to tell its error
    err_keep(&kept);
    stepper_arm_t answer = take_on(axes, on);
    if (answer == STEPPER_ARM_FAILED && err_code() != ERR_TMC_LOST) { // that the monitor tells
        basic_notice("%s", err_message());
    }
    err_put_back(&kept);
    return answer;
}

// A driver that is armed and has lost its settings finds no end of its axis.
void tmc_homing_look(void) {
    for (unsigned driver = 0; driver < TMC22XX_DRIVERS; driver++) {
        tmc22xx_info_t info;
        bool homes = stepper_cycle() == STEPPER_CYCLE_HOMING && tmc22xx_info(driver, &info);
        if (homes && info.armed && info.lost) {
            stepper_stop();
        }
    }
}

// ---- Before wires are closed --------------------------------------------------------------------

err_t tmc_homing_await(void) {
    if (stepper_cycle() == STEPPER_CYCLE_HOMING && arming.drivers != 0) {
        return err_raise(ERR_CYCLE_ACTIVE, "Homing");
    }
    while (stepper_homing_disarms()) {
        if (!basic_wait(hal_time_us() + LOOK_US)) {
            return err_raise(ERR_TMC_BROKEN_OFF, NULL);
        }
    }
    return ERR_OK;
}

void tmc_homing_finish(void) {
    while (stepper_homing_disarms()) {
        control_wait(hal_time_us() + LOOK_US);
    }
}

void tmc_homing_start(void) {
    static const stepper_homing_hook_t hook = {check, arm};
    stepper_homing_set_hook(&hook);
}
