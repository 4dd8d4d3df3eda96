// STEPPER STATUS and PEEK(STEPPER ...). Context: main loop.
#include "basic_cmds/report.h"

#include <math.h>

#include "basic_cmds/gcode_lines.h"
#include "basic_cmds/homing.h"
#include "basic_cmds/job.h"
#include "basic_cmds/machine_outputs.h"
#include "basic_cmds/safety.h"
#include "gcode/gcode.h"
#include "gcode/gcode_job.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_outputs.h"

static const char *yes_no(bool yes) {
    return yes ? "YES" : "NO";
}

const char *report_on_off(bool on) {
    return on ? "ON" : "OFF";
}

const char *report_unit(axis_id_t axis) {
    return axis == AXIS_A ? "deg" : "mm";
}

static void print_axis(axis_id_t axis) {
    stepper_axis_t config;
    if (!stepper_axis_config(axis, &config)) {
        return;
    }
    char name = STEPPER_AXIS_LETTERS[axis];
    const char *unit = report_unit(axis);
    double velocity = fmin(config.max_velocity, stepper_step_rate_limit(axis));
    basic_printf("%c: %.3f %s, machine %.3f %s (%ld steps)\n", name, gcode_work_position(axis),
                 unit, stepper_position(axis), unit, (long)stepper_position_steps(axis));
    basic_printf("%c pins: step %s, dir %s%s, enable %s\n", name, pins_name(config.step_gpio),
                 pins_name(config.dir_gpio), config.dir_invert ? " inverted" : "",
                 pins_name(config.enable_gpio));
    basic_printf("%c motion: %.9g steps/%s, max %.9g %s/min, %.9g %s/s^2\n", name,
                 config.steps_per_unit, unit, velocity, unit, config.max_acceleration, unit);
    double min, max;
    if (stepper_axis_limits(axis, &min, &max)) {
        basic_printf("%c limits: %.3f to %.3f %s\n", name, min, max, unit);
    } else if (axis != AXIS_A) {
        basic_printf("%c limits: none (STEPPER LIMITS)\n", name);
    }
}

static void print_motion(const stepper_status_t *status) {
    const char *motion = status->stopping   ? "STOPPING"
                         : stepper_paused() ? "PAUSE"
                         : status->holding  ? "HOLD"
                         : status->jogging  ? "JOG"
                         : status->moving   ? "ACTIVE"
                                            : "IDLE";
    basic_printf("Armed: %s, motion: %s, position known: %s\n", yes_no(status->armed), motion,
                 yes_no(status->position_known));
}

// Limits go down to thousandths; those that people use read better without.
static void print_jerk(const char *before, double jerk, const char *unit) {
    basic_printf("%s%.*f %s/s^3", before, jerk < 1.0 ? 3 : 1, jerk, unit);
}

static void print_profile(const stepper_status_t *status) {
    basic_printf("Junction deviation: %g mm, arc tolerance: %g mm\n", status->junction_deviation_mm,
                 status->arc_tolerance_mm);
    basic_printf("S-curve: %s", report_on_off(status->scurve));
    print_jerk(", Jerk: ", status->jerk, "mm");
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (status->axis_jerk[axis] > 0.0) {
            const char before[] = {',', ' ', STEPPER_AXIS_LETTERS[axis], ' ', '\0'};
            print_jerk(before, status->axis_jerk[axis], report_unit(axis));
        }
    }
    basic_printf("\n");
}

static void print_queue(const stepper_status_t *status) {
    basic_printf("Buffer: %u of %u used, executed: %u, underruns: %u\n",
                 (unsigned)(status->blocks - status->blocks_free), (unsigned)status->blocks,
                 (unsigned)status->executed, (unsigned)status->underruns);
}

static void print_job(void) {
    if (gcode_job_runs()) {
        basic_printf("G-code file: line %u, %d %% done\n", (unsigned)gcode_job_line(),
                     gcode_job_percent());
    }
}

err_t report_status(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    stepper_status_t status;
    stepper_status(&status);
    if (!status.initialized) {
        basic_printf("Stepper not initialized\n");
        return ERR_OK;
    }
    print_motion(&status);
    print_job();
    print_queue(&status);
    basic_printf("Drivers off when idle: %s\n", report_on_off(status.idle == STEPPER_IDLE_DISABLE));
    basic_printf("Override: feed %d %%, rapid %d %%\n", status.feed_override,
                 status.rapid_override);
    print_profile(&status);
    gcode_lines_report();
    bool asserted = (stepper_status_bits() & STEPPER_STATUS_ESTOP) != 0;
    basic_printf("E-STOP: %s%s, drivers then stay on: %s\n", pins_name(status.estop_gpio),
                 asserted ? " ASSERTED" : "", yes_no(status.estop_keeps_enabled));
    safety_print_status();
    homing_print_status();
    machine_outputs_report();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        print_axis(axis);
    }
    return ERR_OK;
}

err_t report_buffer(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = rules_check(RULES_DO_SETTING);
    if (err != ERR_OK) {
        return err;
    }
    stepper_status_t status;
    stepper_status(&status);
    print_queue(&status);
    basic_printf("Speed: %.9g mm/min, steps:", stepper_speed());
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        basic_printf(" %c %ld", STEPPER_AXIS_LETTERS[axis], (long)stepper_position_steps(axis));
    }
    basic_printf("\n");
    return ERR_OK;
}

err_t report_free_slots(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    *result = (basic_value_t){.type = BASIC_INTEGER, .integer = stepper_blocks_free()};
    return ERR_OK;
}

// A position is a whole number of steps less an offset. Steps of a neat length give a neat number,
// apart from the arithmetic's own error. Of others the shortest number is told that is within a
// hundredth of a step: 33.3 and not 33.299983, which no motor can tell apart.
static double neat(double position, double step) {
    double fine = round(position * 1e6) / 1e6;
    if (fabs(step * 1e6 - round(step * 1e6)) < 1e-6) {
        return fine;
    }
    double scale = 1.0;
    for (unsigned decimals = 0; decimals < 6; decimals++) {
        double shorter = round(position * scale) / scale;
        if (fabs(position - shorter) <= step / 100.0) {
            return shorter;
        }
        scale *= 10.0;
    }
    return fine;
}

static double peek_position(axis_id_t axis) {
    stepper_axis_t config;
    stepper_axis_config(axis, &config);
    return neat(gcode_work_position(axis), 1.0 / config.steps_per_unit);
}

// Also while a file or a line waits for room or for what it has started.
int report_active(void) {
    int active = stepper_active();
    return active == 0 && (gcode_busy() || gcode_job_runs()) ? 1 : active;
}

err_t report_peek(const basic_arg_t *args, size_t count, basic_value_t *result) {
    static const basic_evaluate_t others[] = {
        safety_peek_event,
        job_line,
        job_percent,
        machine_outputs_peek_spindle,
        machine_outputs_peek_coolant,
    };
    (void)count;
    int64_t what = args[0].integer;
    if (what >= PEEK_OTHERS) {
        return others[what - PEEK_OTHERS](NULL, 0, result);
    }
    if (what < AXIS_COUNT) {
        axis_id_t axis = (axis_id_t)what;
        err_t err = stepper_check_axis(axis);
        if (err == ERR_OK) {
            *result = (basic_value_t){.type = BASIC_FLOAT, .number = peek_position(axis)};
        }
        return err;
    }
    if (what == PEEK_SPEED) {
        *result = (basic_value_t){.type = BASIC_FLOAT, .number = stepper_speed()};
        return ERR_OK;
    }
    const int64_t values[] = {report_active(), stepper_status_bits(), stepper_blocks_free()};
    *result = (basic_value_t){.type = BASIC_INTEGER, .integer = values[what - AXIS_COUNT]};
    return ERR_OK;
}
