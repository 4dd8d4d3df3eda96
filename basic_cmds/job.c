// STEPPER FILE, and what becomes of the file; STEPPER CHECK. Context: main loop.
#include "basic_cmds/job.h"

#include "basic_cmds/report.h"
#include "gcode/gcode_job.h"
#include "gcode/gcode_survey.h"
#include "stepper/stepper_safety.h"

err_t job_file(const basic_arg_t *args, size_t count) {
    (void)count;
    err_t err = job_check_free();
    return err != ERR_OK ? err : gcode_job_start(args[0].text.text, args[0].text.length);
}

// ---- Check --------------------------------------------------------------------------------------

static bool go_on(void) {
    return basic_wait(0);
}

static void print_axis(axis_id_t axis, const gcode_report_t *report) {
    const gcode_range_t *work = &report->work[axis];
    const gcode_range_t *machine = &report->machine[axis];
    const char *unit = report_unit(axis);
    basic_printf("%c: %.3f to %.3f %s, machine %.3f to %.3f %s\n", STEPPER_AXIS_LETTERS[axis],
                 work->low, work->high, unit, machine->low, machine->high, unit);
}

static void print_report(const gcode_report_t *report) {
    basic_printf("Lines: %u, moves: %u, pauses: %u\n", (unsigned)report->lines,
                 (unsigned)report->moves, (unsigned)report->pauses);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((report->axes >> axis) & 1) {
            print_axis(axis, report);
        }
    }
    unsigned seconds = (unsigned)report->seconds;
    basic_printf("Time: %u:%02u:%02u (%.2f s)%s\n", seconds / 3600, seconds / 60 % 60, seconds % 60,
                 report->seconds,
                 report->homings + report->probings > 0 ? " besides homing and probing" : "");
}

// The first thing that would be refused becomes the statement's error, behind the report.
static err_t conclude(err_t err, const gcode_report_t *report) {
    if (report->beyond_line != 0) {
        err = err_raise(ERR_SOFT_LIMIT, "%c", STEPPER_AXIS_LETTERS[report->beyond_axis]);
    }
    unsigned line = (unsigned)(report->beyond_line != 0 ? report->beyond_line : report->lines);
    return err == ERR_OK ? ERR_OK : err_raise(ERR_ARGUMENT, "Line %u: %s", line, err_message());
}

err_t job_check(const basic_arg_t *args, size_t count) {
    (void)count;
    gcode_report_t report;
    void *memory = basic_scratch(GCODE_SURVEY_SIZE);
    if (memory == NULL) {
        return err_raise(ERR_NO_MEMORY, NULL);
    }
    err_t err = gcode_survey(memory, args[0].text.text, args[0].text.length, go_on, &report);
    bool unread = err != ERR_OK && report.lines == 0;
    if (unread || basic_break_pending()) {
        return err;
    }
    err_kept_t kept;
    err_keep(&kept);
    print_report(&report);
    err_put_back(&kept);
    return conclude(err, &report);
}

// ---- Progress -----------------------------------------------------------------------------------

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

// ---- Background ---------------------------------------------------------------------------------

static void tell_end(void) {
    unsigned line = (unsigned)gcode_job_line();
    switch (gcode_job_state()) {
    case GCODE_JOB_DONE:
        basic_notice("G-code file done");
        break;
    case GCODE_JOB_STOPPED:
        if (line == 0) {
            basic_notice("G-code file stopped before its first line");
        } else {
            basic_notice("G-code file stopped in line %u", line);
        }
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

// A file whose end nobody has looked at yet, behind a RECOVER on the same line for instance, is in
// nobody's way. While one is being stopped the braking is, and the caller finds that by itself.
err_t job_check_free(void) {
    job_background();
    if (!gcode_job_runs()) {
        return ERR_OK;
    }
    stepper_status_t status;
    stepper_status(&status);
    return status.stopping ? ERR_OK : err_raise(ERR_JOB_RUNS, NULL);
}
