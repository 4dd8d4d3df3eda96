// The ends of jobs: what succeeded counts, what failed is put back as far as it can be. Context:
// main loop.
#include "tmc22xx/endings.h"

#include "tmc22xx/access.h"
#include "tmc22xx/job.h"
#include "tmc22xx/jobs.h"
#include "tmc22xx/monitor.h"
#include "tmc22xx/phases.h"
#include "tmc22xx/wires.h"

static outcome_t statement_outcome, arm_outcome;

const outcome_t *endings_of_statement(void) {
    return &statement_outcome;
}

const outcome_t *endings_of_arm(void) {
    return &arm_outcome;
}

// ---- The end ------------------------------------------------------------------------------------

void endings_finish(void) {
    if (job.kind == JOB_ARM) {
        arm_outcome = job.outcome;
    } else if (job.kind != JOB_MONITOR) {
        statement_outcome = job.outcome;
    }
    job.kind = JOB_NONE;
    if (job.opened && !drivers_on(job.entry.wire)) {
        access_cut(job.entry.wire, false);
        wires_close(job.entry.wire);
    }
}

// What was found out about the driver on the way, whether the job succeeds or not.
static void note_way(driver_t *entry) {
    entry->repeats = (uint16_t)(entry->repeats + access_take_repeats());
    uint8_t count;
    if (access_count(&count)) {
        entry->ifcnt = count;
    }
}

// What others have changed while the job was under way.
static void take_over(const driver_t *now) {
    job.entry.axis = now->axis;
    job.entry.arm_by_user = now->arm_by_user;
    job.entry.arm_tcoolthrs = now->arm_tcoolthrs;
    job.entry.conditions = now->conditions;
    job.entry.told = now->told;
}

static void commit(void) {
    if (job_driver() != NULL) {
        take_over(job_driver());
    }
    job.entry.dirty = 0;
    note_way(&job.entry);
    if (job.kind == JOB_SET_UP) {
        job.entry.listens = job.verify;
        job.entry.conditions = job.entry.told = 0;
        job.driver = job.driver == DRIVERS_NONE ? (uint8_t)drivers_free() : job.driver;
    }
    drivers_put(job.driver, &job.entry);
}

// Writes what the driver should have to those registers that may have something else.
static void restore(uint16_t registers) {
    job.entry = *job_driver();
    job.pending = registers;
    phases_enter(PHASES_RESTORE);
}

// A driver that answers again gets what it could not be told: StallGuard that is off, for instance.
static void end_monitor(void) {
    driver_t *entry = job_driver();
    monitor_note(entry, job.look[0], job.look[1]);
    if (entry->dirty != 0 && (entry->conditions & DRIVERS_LOST) == 0) {
        restore(entry->dirty);
    } else {
        endings_finish();
    }
}

void endings_succeed(void) {
    if (job.kind == JOB_READ || job.kind == JOB_MONITOR) {
        note_way(job_driver());
    } else {
        commit();
    }
    if (job.verify || job.kind == JOB_READ) {
        monitor_note_answer(job_driver());
    }
    if (job.kind == JOB_MONITOR) {
        end_monitor();
    } else if (job.kind != JOB_ARM || !jobs_turn_to_next_armed()) {
        endings_finish();
    }
}

// ---- Failures -----------------------------------------------------------------------------------

// Whoever disarms wants it for all drivers.
static void give_driver_up(void) {
    if (job.kind != JOB_ARM || job.on || !jobs_turn_to_next_armed()) {
        endings_finish();
    }
}

static bool is_of_wire(uint8_t fault) {
    return fault == ACCESS_SILENT || fault == ACCESS_GARBLED || fault == ACCESS_HELD_LOW ||
           fault == ACCESS_NOT_TAKEN;
}

// A driver that may be armed is, until disarming has told. One that cannot be disarmed is not to be
// armed by any later job: the next one puts that right.
static void note_arming(driver_t *entry) {
    if (!job.on) {
        entry->armed = false;
        entry->dirty |= 1u << KEPT_TCOOLTHRS;
    } else if ((job.touched & 1u << KEPT_TCOOLTHRS) != 0) {
        entry->armed = true;
    }
}

static void note_failure(driver_t *entry, uint8_t fault) {
    note_way(entry);
    entry->failures = (uint16_t)(entry->failures + is_of_wire(fault));
    entry->dirty |= job.touched;
    bool nobody_asked = job.kind == JOB_ARM && !job.on && fault == ACCESS_LOST;
    monitor_note_failure(entry, fault, job.kind == JOB_MONITOR || nobody_asked);
    if (job.kind == JOB_ARM) {
        note_arming(entry);
    }
}

void endings_fail(uint8_t fault) {
    if (job.outcome.fault == ACCESS_OK) {
        job.outcome.fault = fault;
    }
    if (job_driver() != NULL) {
        note_failure(job_driver(), fault);
    }
    job.outcome.partly = job.touched != 0 && job.kind != JOB_ARM && fault != ACCESS_LOST;
    if (job.kind == JOB_SET_UP && job.phase == PHASES_IDENTIFY && fault == ACCESS_SILENT) {
        job.next = 0;
        phases_enter(PHASES_KNOCK);
    } else if (job.outcome.partly && job_driver() != NULL) {
        restore(job.touched);
    } else {
        give_driver_up();
    }
}

void endings_fail_access(void) {
    switch ((phases_t)job.phase) {
    case PHASES_LOOK:
        if (job.kind == JOB_READ) { // what was wanted is there
            endings_succeed();
            return;
        }
        break;
    case PHASES_RESTORE:
        endings_finish(); // what is left stays dirty
        return;
    case PHASES_KNOCK:
        job.next++;
        phases_enter(PHASES_KNOCK);
        return;
    default:
        break;
    }
    if (job.phase == PHASES_WRITE && access_is_in_doubt()) {
        job.touched |= (uint16_t)(1u << job.writing);
    }
    endings_fail((uint8_t)access_fault());
}
