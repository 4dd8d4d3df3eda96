// Spindle, coolant and pauses: what the user is told about them. Inside basic_cmds/ only. Context:
// main loop.
#ifndef BASIC_CMDS_MACHINE_OUTPUTS_H
#define BASIC_CMDS_MACHINE_OUTPUTS_H

// Their lines of STEPPER STATUS.
void machine_outputs_report(void);

// Tells what has happened; called often.
void machine_outputs_background(void);

// The queue has come to a pause.
void machine_outputs_tell_pause(void);

#endif
