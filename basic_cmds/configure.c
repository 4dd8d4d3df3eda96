// STEPPER INIT, AXIS, LIMITS, SPINDLE, COOLANT, JUNCTION, SCURVE, JERK, ARC LEGACY. Context: main loop.
#include "basic_cmds/configure.h"

#include "basic_cmds/gcode_lines.h"
#include "gcode/gcode.h"
#include "stepper/rules.h"
#include "stepper/stepper.h"
#include "stepper/stepper_outputs.h"

err_t configure_init(const basic_arg_t *args, size_t count) {
    (void)count;
    stepper_init_t config = {
        .arc_tolerance_mm = args[INIT_TOLERANCE].number,
        .blocks = (uint32_t)args[INIT_BUFFER].integer,
        .estop_gpio = (uint8_t)args[INIT_ESTOP].integer,
        .estop_keeps_enabled = args[INIT_KEEP].integer != 0,
    };
    err_t err = stepper_init(&config);
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
                     STEPPER_AXIS_LETTERS[axis], reachable, axis == AXIS_A ? "deg" : "mm");
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

err_t configure_arc_legacy(const basic_arg_t *args, size_t count) {
    (void)count;
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        gcode_options_t options = *gcode_options();
        options.arc_legacy = args[0].integer != 0;
        gcode_set_options(&options);
    }
    return err;
}
