// STEPPER FILE, and what becomes of the file. Context: main loop.
#include "basic_cmds/job.h"

#include "gcode/gcode_job.h"
#include "stepper/stepper_safety.h"

err_t job_file(const basic_arg_t *args, size_t count) {
    (void)count;
    return gcode_job_start(args[0].text.text, args[0].text.length);
}

err_t job_line(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    *result = (basic_value_t){.type = BASIC_INTEGER, .integer = gcode_job_line()};
    return ERR_OK;
}

err_t job_percent(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    *result = (basic_value_t){.type = BASIC_INTEGER, .integer = gcode_job_percent()};
    return ERR_OK;
}

err_t job_check_free(void) {
    return gcode_job_runs() ? err_raise(ERR_JOB_RUNS, NULL) : ERR_OK;
}

// ---- Background ---------------------------------------------------------------------------------

static void tell_end(void) {
    unsigned line = (unsigned)gcode_job_line();
    switch (gcode_job_state()) {
    case GCODE_JOB_DONE:
        basic_notice("G-code file done");
        break;
    case GCODE_JOB_STOPPED:
        basic_notice("G-code file stopped in line %u", line);
        break;
    case GCODE_JOB_FAILED:
        basic_notice("G-code file ended before line %u", (unsigned)gcode_job_read_line());
        break;
    case GCODE_JOB_NONE:
    case GCODE_JOB_RUNS:
        break;
    }
    stepper_raise_event(STEPPER_EVENT_JOB_DONE);
}

void job_background(void) {
    if (!gcode_job_runs()) {
        return;
    }
    bool more;
    err_kept_t kept; // the statement in the foreground may be about to tell its error
    err_keep(&kept);
    if (gcode_job_background(&more) != ERR_OK) {
        basic_notice("Line %u: %s", (unsigned)gcode_job_read_line(), err_message());
    }
    err_put_back(&kept);
    if (!gcode_job_runs()) {
        tell_end();
        basic_wake(); // for whoever waits for the event
    } else if (more) {
        basic_wake();
    }
}
