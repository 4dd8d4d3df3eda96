// The product's own words as rows for the language: STEPPER ... and PEEK(STEPPER ...). The face of
// basic_cmds/. Handlers convert units and call one function of another face; no motion logic, no
// parsing. Context: main loop.
#ifndef BASIC_CMDS_H
#define BASIC_CMDS_H

#include "basic/basic.h"

// All rows, by subject.
extern const basic_rows_t *const basic_cmds_tables[];
extern const size_t basic_cmds_table_count;

extern const struct basic_device *const basic_cmds_devices[];
extern const size_t basic_cmds_device_count;

// Before anything else here.
void basic_cmds_start(void);

// A new program or RUN: what the last program made of pins is put back.
void basic_cmds_clear(void);

// RUN and NEW: motion comes to a controlled stop, then the machine is closed as after power-up.
void basic_cmds_new(void);

// Tells the user what the machine did without being asked; for the language's background hook.
void basic_cmds_background(void);

// Ctrl-C: brings motion to a controlled stop.
void basic_cmds_break(void);

// An error has ended a program: motion stops or runs out, as OPTION ERROR says. Drivers stay on.
void basic_cmds_error(void);

// Refuses a restart while motion is active or queued.
err_t basic_cmds_may_restart(void);

// A G-code file is being carried out in the background.
bool basic_cmds_job_runs(void);

// Ctrl-F is feed hold, Ctrl-R resumes. False while there is nothing they could act on, and for all
// other characters.
bool basic_cmds_control(char c);

#endif
