// STEPPER RUN, CLEAR, STOP, HOLD, RESUME, OVERRIDE, JOG, ESTOP, CLOSE, POSITION. Context: main
// loop.
#include "basic_cmds/control.h"

#include <math.h>

#include "basic_cmds/basic_cmds.h"
#include "basic_cmds/job.h"
#include "basic_cmds/report.h"
#include "basic_cmds/safety.h"
#include "gcode/gcode.h"
#include "stepper/rules.h"
#include "stepper/stepper.h"

#define STOP_LOOK_US 1000u

// The mode may stand with or without the comma that the reference puts before it.
err_t control_run(const basic_arg_t *args, size_t count) {
    (void)count;
    stepper_status_t status;
    stepper_status(&status);
    stepper_idle_t idle = status.idle;
    for (size_t i = 0; i < 2; i++) {
        if (args[i].given) {
            idle = (stepper_idle_t)args[i].integer;
        }
    }
    err_t err = stepper_run(idle);
    if (err == ERR_OK) {
        basic_printf(status.armed ? "Already armed\n" : "Stepper armed\n");
        safety_warn();
    }
    return err;
}

err_t control_clear(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = stepper_clear();
    if (err == ERR_OK) {
        gcode_reset_modal();
    }
    return err;
}

err_t control_stop(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = rules_check(RULES_DO_STOP);
    if (err == ERR_OK) {
        stepper_stop();
    }
    return err;
}

err_t control_hold(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return stepper_hold(true);
}

err_t control_resume(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return stepper_hold(false);
}

static err_t show_override(void) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err != ERR_OK) {
        return err;
    }
    stepper_status_t status;
    stepper_status(&status);
    basic_printf("Override: feed %d %%, rapid %d %%\n", status.feed_override,
                 status.rapid_override);
    return ERR_OK;
}

err_t control_override(const basic_arg_t *args, size_t count) {
    (void)count;
    if (!args[0].given && !args[1].given) {
        return show_override();
    }
    if (!args[0].given || !args[1].given) {
        return err_raise(ERR_ARGUMENTS_MISSING, args[0].given ? "percent" : "what");
    }
    bool rapid = args[0].integer != 0;
    int percent = (int)args[1].integer;
    if (rapid && percent > STEPPER_OVERRIDE_RAPID_MAX) {
        return err_raise(ERR_ARGUMENT, "percent: %d is invalid (valid is %d to %d for RAPID)",
                         percent, STEPPER_OVERRIDE_MIN, STEPPER_OVERRIDE_RAPID_MAX);
    }
    stepper_status_t status;
    stepper_status(&status);
    return stepper_override(rapid ? status.feed_override : percent,
                            rapid ? percent : status.rapid_override);
}

err_t control_jog(const basic_arg_t *args, size_t count) {
    (void)count;
    const basic_arg_t *wanted = &args[JOG_DISTANCE];
    double distance = wanted->number;
    if (wanted->text.length > 0) {
        distance = wanted->integer == JOG_DOWN ? -(double)INFINITY : (double)INFINITY;
    }
    err_t err = job_check_free();
    return err != ERR_OK
               ? err
               : stepper_jog((axis_id_t)args[JOG_AXIS].integer, distance, args[JOG_FEED].number);
}

err_t control_jog_stop(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return stepper_jog_stop();
}

err_t control_estop(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = stepper_estop();
    if (err == ERR_OK) {
        gcode_reset_modal();
        stepper_status_t status;
        stepper_status(&status);
        basic_printf("Emergency stop - motion halted, buffer cleared, drivers %s\n",
                     status.estop_keeps_enabled ? "still enabled" : "disabled");
    }
    return err;
}

void control_wait(uint64_t until_us) {
    if (!basic_wait(until_us)) {
        hal_idle(until_us);
        basic_cmds_background();
    }
}

void control_await_stop(void) {
    stepper_stop();
    while (report_active() > 0) {
        control_wait(hal_time_us() + STOP_LOOK_US);
    }
}

err_t control_close(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = rules_check(RULES_DO_STOP);
    if (err != ERR_OK) {
        return err;
    }
    control_await_stop();
    return stepper_close();
}

err_t control_position_home(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = stepper_set_home();
    if (err == ERR_OK) {
        gcode_clear_offsets();
    }
    return err;
}

err_t control_position(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_set_position((axis_id_t)args[0].integer, args[1].number);
}

#define OPTION_ERROR "ERROR"
enum { ERROR_STOPS, ERROR_LETS_RUN }; // in the order of CONTROL_ERROR_CHOICES

err_t control_option_error(const basic_arg_t *args, size_t count) {
    (void)count;
    return basic_set_option(OPTION_ERROR, args[0].integer);
}

void control_error(void) {
    if (stepper_active() < 0 || basic_option(OPTION_ERROR, ERROR_STOPS) == ERROR_LETS_RUN) {
        return;
    }
    if (stepper_active() > 0) {
        basic_notice("Error: motion stops, what was queued is dropped");
    }
    stepper_stop();
}
