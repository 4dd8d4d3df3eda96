// Handlers that tell about the machine. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_REPORT_H
#define BASIC_CMDS_REPORT_H

#include "basic/basic.h"
#include "stepper/stepper.h"

err_t report_status(const basic_arg_t *args, size_t count);
// PEEK(STEPPER ACTIVE): -1 not initialised, 1 working, 0 idle.
int report_active(void);

err_t report_buffer(const basic_arg_t *args, size_t count);

// How all reports put it.
const char *report_unit(axis_id_t axis); // "mm" or "deg"
const char *report_on_off(bool on);

// MM.CODE
err_t report_free_slots(const basic_arg_t *args, size_t count, basic_value_t *result);

// PEEK(STEPPER what); PEEK_CHOICES says what there is, in the order of the handler's cases.
// Those from PEEK_OTHERS on have rows of their own as well, which explain them.
#define PEEK_CHOICES "X|Y|Z|A|ACTIVE|STATUS|BUFFER|SPEED|EVENT|LINE|PERCENT|SPINDLE|COOLANT"
#define PEEK_SPEED (AXIS_COUNT + 3)
#define PEEK_OTHERS (AXIS_COUNT + 4)
err_t report_peek(const basic_arg_t *args, size_t count, basic_value_t *result);

#endif
