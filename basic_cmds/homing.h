// Handlers of STEPPER HOME and STEPPER PROBE. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_HOMING_H
#define BASIC_CMDS_HOMING_H

#include "basic/basic.h"

err_t homing_configure(const basic_arg_t *args, size_t count);
err_t homing_order(const basic_arg_t *args, size_t count);
err_t homing_run(const basic_arg_t *args, size_t count);
err_t homing_probe_pin(const basic_arg_t *args, size_t count);

// Where each argument stands in the row's spec.
enum {
    HOME_AXIS,
    HOME_END,
    HOME_SEEK,
    HOME_LATCH,
    HOME_PULL_OFF,
    HOME_TRAVEL,
    HOME_POSITION,
    HOME_ARGS
};
#define HOME_END_CHOICES "MIN|MAX"

// PEEK(STEPPER PROBE what), in the order of the choices behind the axes.
#define PROBE_CHOICES "X|Y|Z|A|OK|CONTACT"
err_t homing_peek_probe(const basic_arg_t *args, size_t count, basic_value_t *result);

// For the background hook: takes homing and probing on, and tells how STEPPER HOME RUN failed.
void homing_background(void);

// For STATUS.
void homing_print_status(void);

#endif
