// Spindle, coolant and pauses: what the user is told about them. Inside basic_cmds/ only. Context:
// main loop.
#ifndef BASIC_CMDS_MACHINE_OUTPUTS_H
#define BASIC_CMDS_MACHINE_OUTPUTS_H

#include "basic/basic.h"

// Their lines of STEPPER STATUS.
void machine_outputs_report(void);

// PEEK(STEPPER SPINDLE), PEEK(STEPPER COOLANT).
err_t machine_outputs_peek_spindle(const basic_arg_t *args, size_t count, basic_value_t *result);
err_t machine_outputs_peek_coolant(const basic_arg_t *args, size_t count, basic_value_t *result);

// Tells what has happened; called often.
void machine_outputs_background(void);

// The queue has come to a pause.
void machine_outputs_tell_pause(void);

#endif
