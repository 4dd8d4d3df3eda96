// Handlers that set the machine up. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_CONFIGURE_H
#define BASIC_CMDS_CONFIGURE_H

#include "basic/basic.h"

err_t configure_init(const basic_arg_t *args, size_t count);
err_t configure_axis(const basic_arg_t *args, size_t count);
err_t configure_tune(const basic_arg_t *args, size_t count);
err_t configure_invert(const basic_arg_t *args, size_t count);
err_t configure_enable(const basic_arg_t *args, size_t count);
err_t configure_reset(const basic_arg_t *args, size_t count);
err_t configure_arc(const basic_arg_t *args, size_t count);
err_t configure_limits(const basic_arg_t *args, size_t count);
err_t configure_spindle(const basic_arg_t *args, size_t count);
err_t configure_laser(const basic_arg_t *args, size_t count);
err_t configure_coolant(const basic_arg_t *args, size_t count);
err_t configure_junction(const basic_arg_t *args, size_t count);
err_t configure_scurve(const basic_arg_t *args, size_t count);
err_t configure_jerk(const basic_arg_t *args, size_t count);

#define CONFIGURE_TOLERANCE 0.05 // mm
#define CONFIGURE_TOLERANCE_MAX 10.0
#define CONFIGURE_ALL_AXES "ALL" // the word behind the axes' letters

// Where each argument stands in the row's spec.
enum { INIT_TOLERANCE, INIT_BUFFER, INIT_ESTOP, INIT_KEEP, INIT_ARGS };
enum {
    AXIS_ARG_AXIS,
    AXIS_ARG_STEP,
    AXIS_ARG_DIR,
    AXIS_ARG_ENABLE,
    AXIS_ARG_INVERT,
    AXIS_ARG_SCALE,
    AXIS_ARG_VELOCITY,
    AXIS_ARG_ACCELERATION,
    AXIS_ARG_BACKOFF,
    AXIS_ARGS
};
enum {
    TUNE_AXIS,
    TUNE_INVERT,
    TUNE_SCALE,
    TUNE_VELOCITY,
    TUNE_ACCELERATION,
    TUNE_BACKOFF,
    TUNE_ARGS
};
enum { LIMITS_AXIS, LIMITS_MIN, LIMITS_MAX, LIMITS_ARGS };
enum {
    SPINDLE_PIN,
    SPINDLE_INVERT,
    SPINDLE_MAX,
    SPINDLE_MIN,
    SPINDLE_PWM,
    SPINDLE_SPINUP,
    SPINDLE_DIR,
    SPINDLE_ARGS
};
enum { COOLANT_FLOOD, COOLANT_MIST, COOLANT_INVERT, COOLANT_ARGS };

#endif
