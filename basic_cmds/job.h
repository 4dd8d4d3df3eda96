// Handlers of STEPPER FILE and STEPPER CHECK. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_JOB_H
#define BASIC_CMDS_JOB_H

#include "basic/basic.h"

err_t job_file(const basic_arg_t *args, size_t count);
err_t job_check(const basic_arg_t *args, size_t count);

// PEEK(STEPPER LINE), PEEK(STEPPER PERCENT)
err_t job_line(const basic_arg_t *args, size_t count, basic_value_t *result);
err_t job_percent(const basic_arg_t *args, size_t count, basic_value_t *result);

// Raises an error while a file runs: nothing else may queue G-code or jog then.
err_t job_check_free(void);

// For the background hook: feeds the file and tells how it ended.
void job_background(void);

#endif
