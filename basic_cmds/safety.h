// Handlers about inputs that stop the machine, alarms and events. Inside basic_cmds/ only.
// Context: main loop.
#ifndef BASIC_CMDS_SAFETY_H
#define BASIC_CMDS_SAFETY_H

#include "basic/basic.h"

enum { HWLIMITS_INVERT = 6, HWLIMITS_ARGS }; // behind three minimum and three maximum pins

err_t safety_hwlimits(const basic_arg_t *args, size_t count);
err_t safety_filter(const basic_arg_t *args, size_t count);
err_t safety_keep(const basic_arg_t *args, size_t count);
err_t safety_recover(const basic_arg_t *args, size_t count);
err_t safety_on_event(const basic_arg_t *args, size_t count);

// PEEK(STEPPER EVENT): takes the oldest.
err_t safety_peek_event(const basic_arg_t *args, size_t count, basic_value_t *result);

// After arming: names the switches that are pressed.
void safety_warn(void);

// Their part of STEPPER STATUS.
void safety_print_status(void);

// Tells the user and the program what has happened in the machine.
void safety_background(void);

// A program starts afresh: no SUB for events, and none of them waits.
void safety_clear(void);

#endif
