// A G-code file that is carried out in the background. Context: main loop.
#include "gcode/gcode_job.h"

#include "gcode/gcode.h"
#include "gcode/gcode_file.h"
#include "gcode/gcode_interpreter.h"
#include "stepper/rules.h"
#include "stepper/stepper_outputs.h"
#include "stepper/stepper_safety.h"

// Lines for one turn of the background: a program beside the file goes on within 2 ms.
#define LINES_PER_TURN 8u

typedef enum {
    PHASE_IDLE,
    PHASE_READING,
    PHASE_ENDING // nothing more is read; what was queued is still being executed
} phase_t;

static struct {
    phase_t phase;
    gcode_job_state_t result; // how it ended, or will
    bool waiting;             // for homing or probing
    uint32_t drops;           // of the queue, when it was looked at last
    uint32_t read;            // bytes, up to the line read last
    uint32_t line;            // being executed, the last that was known
    int percent;
    gcode_file_t file;
} job;

gcode_job_state_t gcode_job_state(void) {
    return job.phase == PHASE_IDLE ? job.result : GCODE_JOB_RUNS;
}

err_t gcode_job_start(const char *name, size_t length) {
    err_t err = rules_check(RULES_DO_FILE);
    if (err == ERR_OK && gcode_job_runs()) {
        err = err_raise(ERR_JOB_RUNS, NULL);
    }
    if (err == ERR_OK && gcode_busy()) {
        err = err_raise(ERR_GCODE_BUFFER_FULL, NULL);
    }
    if (err == ERR_OK) {
        err = gcode_file_open(&job.file, name, length);
    }
    if (err == ERR_OK) {
        gcode_take_end();
        job.phase = PHASE_READING;
        job.result = GCODE_JOB_DONE;
        job.waiting = false;
        job.drops = stepper_drops();
        job.read = 0;
        job.line = 0;
        job.percent = 0;
    }
    return err;
}

// ---- Feeding ------------------------------------------------------------------------------------

static void end_reading(gcode_job_state_t result) {
    if (job.phase == PHASE_READING) {
        gcode_file_close(&job.file);
        stepper_set_line(0);
    }
    job.result = result;
    job.phase = PHASE_ENDING;
}

static err_t feed_line(void) {
    bool more;
    err_t err = gcode_file_next(&job.file, &more);
    if (err == ERR_OK && more) {
        job.read = gcode_file_position(&job.file);
        stepper_set_line(job.file.line);
        err = gcode_line(gcode_file_text(&job.file), gcode_file_length(&job.file));
    }
    if (err != ERR_OK) {
        end_reading(GCODE_JOB_FAILED);
    } else if (!more || gcode_take_end()) {
        end_reading(GCODE_JOB_DONE);
    }
    return err;
}

// There is room for any entry, so no line is refused for want of it.
static bool can_feed(void) {
    return job.phase == PHASE_READING && !gcode_busy() && stepper_blocks_free() > 0;
}

// Homing and probing drop what is left of their own moves; all other drops end the file.
static bool was_dropped(void) {
    uint32_t drops = stepper_drops();
    bool dropped = drops != job.drops && !job.waiting;
    job.waiting = gcode_must_wait();
    job.drops = drops;
    return dropped;
}

static err_t feed(void) {
    err_t err = gcode_failure();
    if (err != ERR_OK) {
        end_reading(GCODE_JOB_FAILED);
    } else if (!gcode_busy() && gcode_take_end()) {
        end_reading(GCODE_JOB_DONE);
    }
    for (unsigned n = 0; n < LINES_PER_TURN && err == ERR_OK && can_feed(); n++) {
        err = feed_line();
    }
    return err;
}

// The queue of a stopped file is dropped: what moves once it stands is not the file's.
static bool all_done(void) {
    stepper_status_t status;
    stepper_status(&status);
    return job.result == GCODE_JOB_STOPPED ? !status.stopping
                                           : !gcode_busy() && stepper_active() <= 0;
}

// A file may end without M5. Where one was stopped the laser is off, or somebody else's.
static void put_laser_out(void) {
    if (job.result != GCODE_JOB_STOPPED && stepper_is_laser()) {
        stepper_laser_off();
        gcode_live.state.modal.spindle = STEPPER_SPINDLE_OFF;
    }
}

err_t gcode_job_background(bool *more) {
    *more = false;
    if (job.phase == PHASE_IDLE) {
        return ERR_OK;
    }
    gcode_background();
    gcode_job_line(); // it is forgotten as soon as nothing moves
    if (was_dropped()) {
        end_reading(GCODE_JOB_STOPPED);
    }
    err_t err = feed();
    if (job.phase == PHASE_ENDING && all_done()) {
        int percent = gcode_job_percent();
        job.percent = job.result == GCODE_JOB_DONE ? 100 : percent;
        job.phase = PHASE_IDLE;
        put_laser_out();
    }
    *more = can_feed();
    return err;
}

// ---- Progress -----------------------------------------------------------------------------------

uint32_t gcode_job_read_line(void) {
    return job.file.line;
}

uint32_t gcode_job_line(void) {
    if (job.phase != PHASE_IDLE) {
        uint32_t line = stepper_line();
        job.line = line != 0 ? line : job.line;
    }
    return job.line;
}

// Of the bytes that were read, in the proportion of the lines. It never goes back.
int gcode_job_percent(void) {
    uint32_t line = gcode_job_line();
    if (job.phase != PHASE_IDLE && job.file.line > 0 && job.file.size > 0 &&
        line <= job.file.line) {
        uint64_t done = (uint64_t)job.read * line / job.file.line;
        int percent = (int)(done * 100 / job.file.size);
        job.percent = percent > job.percent ? percent : job.percent;
    }
    return job.percent;
}
