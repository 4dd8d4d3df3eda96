// STEPPER INIT, AXIS, TUNE, INVERT, ENABLE, RESET, LIMITS, SPINDLE, COOLANT, JUNCTION, SCURVE,
// JERK, ARC. Context: main loop.
#include "basic_cmds/configure.h"

#include <math.h>

#include "basic_cmds/gcode_lines.h"
#include "basic_cmds/report.h"
#include "gcode/gcode.h"
#include "stepper/rules.h"
#include "stepper/stepper_axes.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_outputs.h"

static err_t check_init(double tolerance, double blocks) {
    if (!(tolerance > 0.0 && tolerance <= CONFIGURE_TOLERANCE_MAX)) {
        return err_raise(ERR_ARGUMENT, "arc_tolerance: %g is invalid (valid is above 0 to %g)",
                         tolerance, CONFIGURE_TOLERANCE_MAX);
    }
    if (!(blocks >= 1.0 && blocks <= (double)STEPPER_BLOCKS_MAX)) {
        return err_raise(ERR_ARGUMENT, "buffer_size: %g is invalid (valid is 1 to %u)", blocks,
                         STEPPER_BLOCKS_MAX);
    }
    return ERR_OK;
}

// Tolerance and buffer size may stand in either order: the one that is too large for a tolerance,
// or too small for a size, is the other.
err_t configure_init(const basic_arg_t *args, size_t count) {
    (void)count;
    const basic_arg_t *first = &args[INIT_TOLERANCE];
    const basic_arg_t *second = &args[INIT_BUFFER];
    bool swapped = (first->given && first->number > CONFIGURE_TOLERANCE_MAX) ||
                   (second->given && second->number > 0.0 && second->number < 1.0);
    double tolerance = first->number;
    double blocks = second->number;
    if (swapped) {
        tolerance = second->given ? second->number : CONFIGURE_TOLERANCE;
        blocks = first->given ? first->number : (double)STEPPER_BLOCKS_DEFAULT;
    }
    blocks = floor(blocks + 0.5);
    err_t err = check_init(tolerance, blocks);
    if (err != ERR_OK) {
        return err;
    }
    stepper_init_t config = {
        .arc_tolerance_mm = tolerance,
        .blocks = (uint32_t)blocks,
        .estop_gpio = (uint8_t)args[INIT_ESTOP].integer,
        .estop_keeps_enabled = args[INIT_KEEP].integer != 0,
    };
    err = stepper_init(&config);
    if (err == ERR_OK) {
        gcode_lines_reset();
        basic_printf("Stepper initialized, buffer %u\n", (unsigned)config.blocks);
    }
    return err;
}

static void warn_of_rate_limit(axis_id_t axis, double velocity) {
    double reachable = stepper_step_rate_limit(axis);
    if (velocity > reachable) {
        basic_printf("Warning: %c axis max speed limited to %.1f %s/min by the 50 kHz step rate\n",
                     STEPPER_AXIS_LETTERS[axis], reachable, report_unit(axis));
    }
}

err_t configure_axis(const basic_arg_t *args, size_t count) {
    (void)count;
    axis_id_t axis = (axis_id_t)args[AXIS_ARG_AXIS].integer;
    stepper_axis_t config = {
        .step_gpio = (uint8_t)args[AXIS_ARG_STEP].integer,
        .dir_gpio = (uint8_t)args[AXIS_ARG_DIR].integer,
        .enable_gpio = (uint8_t)args[AXIS_ARG_ENABLE].integer,
        .dir_invert = args[AXIS_ARG_INVERT].integer != 0,
        .steps_per_unit = args[AXIS_ARG_SCALE].number,
        .max_velocity = args[AXIS_ARG_VELOCITY].number,
        .max_acceleration = args[AXIS_ARG_ACCELERATION].number,
        .home_backoff_mm = args[AXIS_ARG_BACKOFF].number,
    };
    err_t err = stepper_axis(axis, &config);
    if (err == ERR_OK) {
        warn_of_rate_limit(axis, config.max_velocity);
    }
    return err;
}

static void print_axis(axis_id_t axis, const stepper_axis_t *config) {
    const char *unit = report_unit(axis);
    basic_printf("%c axis: %.9g steps/%s, max %.9g %s/min, %.9g %s/s^2%s\n",
                 STEPPER_AXIS_LETTERS[axis], config->steps_per_unit, unit, config->max_velocity,
                 unit, config->max_acceleration, unit, config->dir_invert ? ", inverted" : "");
    warn_of_rate_limit(axis, config->max_velocity);
}

static err_t tune(axis_id_t axis, const stepper_axis_t *config) {
    stepper_status_t before, now;
    stepper_status(&before);
    err_t err = stepper_tune(axis, config);
    if (err == ERR_OK) {
        print_axis(axis, config);
        stepper_status(&now);
        if (before.position_known && !now.position_known) {
            basic_printf("Position unknown with another scale: home (G28) or use STEPPER "
                         "POSITION\n");
        }
    }
    return err;
}

err_t configure_tune(const basic_arg_t *args, size_t count) {
    axis_id_t axis = (axis_id_t)args[TUNE_AXIS].integer;
    bool any = false;
    for (size_t i = TUNE_INVERT; i < count; i++) {
        any = any || args[i].given;
    }
    stepper_axis_t config;
    stepper_axis_config(axis, &config);
    if (args[TUNE_INVERT].given) {
        config.dir_invert = args[TUNE_INVERT].integer != 0;
    }
    double *const values[TUNE_ARGS] = {
        [TUNE_SCALE] = &config.steps_per_unit,
        [TUNE_VELOCITY] = &config.max_velocity,
        [TUNE_ACCELERATION] = &config.max_acceleration,
        [TUNE_BACKOFF] = &config.home_backoff_mm,
    };
    for (size_t i = TUNE_SCALE; i < TUNE_ARGS; i++) {
        *values[i] = args[i].given ? args[i].number : *values[i];
    }
    return any ? tune(axis, &config) : err_raise(ERR_NOTHING_TO_TUNE, NULL);
}

err_t configure_invert(const basic_arg_t *args, size_t count) {
    (void)count;
    axis_id_t axis = (axis_id_t)args[0].integer;
    stepper_axis_t config;
    stepper_axis_config(axis, &config);
    config.dir_invert = args[1].integer != 0;
    return stepper_tune(axis, &config);
}

err_t configure_enable(const basic_arg_t *args, size_t count) {
    (void)count;
    axis_id_t axis = (axis_id_t)args[0].integer; // AXIS_COUNT: all of them
    bool one = axis < AXIS_COUNT;
    err_t err = one && stepper_active() >= 0 ? stepper_check_axis(axis) : ERR_OK;
    uint32_t wanted = one ? 1u << axis : (1u << AXIS_COUNT) - 1;
    return err == ERR_OK ? stepper_enable(wanted, args[1].integer != 0) : err;
}

err_t configure_reset(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = stepper_reset();
    if (err == ERR_OK) {
        gcode_reset();
    }
    return err;
}

err_t configure_arc(const basic_arg_t *args, size_t count) {
    (void)count;
    if (args[0].given) {
        return stepper_arc_tolerance(args[0].number);
    }
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        stepper_status_t status;
        stepper_status(&status);
        basic_printf("Arc tolerance %g mm\n", status.arc_tolerance_mm);
    }
    return err;
}

err_t configure_limits(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_limits((axis_id_t)args[LIMITS_AXIS].integer, args[LIMITS_MIN].number,
                          args[LIMITS_MAX].number);
}

err_t configure_spindle(const basic_arg_t *args, size_t count) {
    (void)count;
    stepper_spindle_t config = {
        .gpio = (uint8_t)args[SPINDLE_PIN].integer,
        .dir_gpio = (uint8_t)args[SPINDLE_DIR].integer,
        .invert = args[SPINDLE_INVERT].integer != 0,
        .max_rpm = args[SPINDLE_MAX].number,
        .min_rpm = args[SPINDLE_MIN].number,
        .pwm_hz = args[SPINDLE_PWM].number,
        .spinup_ms = (uint32_t)args[SPINDLE_SPINUP].integer,
    };
    return stepper_spindle(&config);
}

err_t configure_laser(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_laser(args[0].integer != 0);
}

err_t configure_coolant(const basic_arg_t *args, size_t count) {
    (void)count;
    stepper_coolant_t config = {
        .flood_gpio = (uint8_t)args[COOLANT_FLOOD].integer,
        .mist_gpio = (uint8_t)args[COOLANT_MIST].integer,
        .invert = args[COOLANT_INVERT].integer != 0,
    };
    return stepper_coolant(&config);
}

err_t configure_junction(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_junction(args[0].number);
}

err_t configure_scurve(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_scurve(args[0].integer != 0);
}

// Behind the value for the path there is one for each axis, 0 where it was left out.
err_t configure_jerk(const basic_arg_t *args, size_t count) {
    (void)count;
    double axis_jerk[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        axis_jerk[axis] = args[1 + axis].number;
    }
    return stepper_jerk(args[0].number, axis_jerk);
}
