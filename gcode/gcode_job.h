// A G-code file of A: that is carried out in the background, while the prompt and programs go on.
// One at a time. A further face of gcode/. Context: main loop.
//
// Its lines go where gcode_line() puts them, as the queue has room. Feed hold, overrides and stops
// act on the queue, so they act on the file as well; whoever drops the queue ends the file. While
// one runs nobody else should queue anything.
#ifndef GCODE_JOB_H
#define GCODE_JOB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

typedef enum {
    GCODE_JOB_NONE,    // there was none since the start
    GCODE_JOB_RUNS,    // lines are read, or what they queued is executed
    GCODE_JOB_DONE,    // all was executed
    GCODE_JOB_STOPPED, // its queue was dropped: a stop, an emergency stop, a limit
    GCODE_JOB_FAILED   // a line was refused; what came before it was executed
} gcode_job_state_t;

// Errors: one is running, the machine is not ready for motion, the file cannot be read.
err_t gcode_job_start(const char *name, size_t length);

// Feeds the next lines, a few at most so that whoever calls it is not held up. An error is that of
// line gcode_job_read_line() and ends the reading. *more: it could go on at once.
err_t gcode_job_background(bool *more);

gcode_job_state_t gcode_job_state(void);
static inline bool gcode_job_runs(void) {
    return gcode_job_state() == GCODE_JOB_RUNS;
}

// The line that was read last, from 1; the one that is being executed or was last, 0: none yet; and
// how much of the file has been executed, 0..100.
uint32_t gcode_job_read_line(void);
uint32_t gcode_job_line(void);
int gcode_job_percent(void);

#endif
