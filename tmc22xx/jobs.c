// Beginning jobs and taking them on. Context: main loop.
#include "tmc22xx/jobs.h"

#include <string.h>

#include "tmc22xx/access.h"
#include "tmc22xx/endings.h"
#include "tmc22xx/job.h"
#include "tmc22xx/phases.h"
#include "tmc22xx/wires.h"
#include "tmc22xx/tmc22xx_registers.h"

job_t job;
job_reading_t job_reading;

static bool blind; // nothing is verified

// ---- Beginnings ---------------------------------------------------------------------------------

static void turn_to(const driver_t *entry) {
    job.entry = *entry;
    job.touched = 0;
    if (job.outcome.fault == ACCESS_OK) {
        job.outcome = (outcome_t){
            .tx_gpio = wires_get(entry->wire)->tx_gpio,
            .rx_gpio = wires_get(entry->wire)->rx_gpio,
            .address = entry->address,
            .axis = entry->axis,
            .chip = entry->chip,
            .is_being_set = job.kind == JOB_SET_UP,
        };
    }
    access_turn_to(entry->wire, entry->address, job_knows_resets());
}

static void begin(job_kind_t kind, unsigned index, const driver_t *entry) {
    memset(&job, 0, sizeof job);
    job.kind = (uint8_t)kind;
    job.driver = (uint8_t)index;
    job.verify = !blind;
    turn_to(entry);
}

void jobs_set_up(unsigned index, const driver_t *entry, bool opened) {
    begin(JOB_SET_UP, index, entry);
    job.opened = opened;
    job.pending = KEPT_SET_UP | entry->dirty;
    phases_enter(job.verify ? PHASES_IDENTIFY : PHASES_WRITE);
}

void jobs_change(unsigned index, const driver_t *entry, uint32_t kept) {
    begin(JOB_CHANGE, index, entry);
    job.pending = (uint16_t)(kept | entry->dirty);
    phases_enter(PHASES_WRITE);
}

void jobs_write(unsigned index, uint8_t reg, uint32_t value) {
    begin(JOB_CHANGE, index, drivers_get(index));
    job.pending = job.entry.dirty;
    job.has_raw = true;
    job.raw_reg = reg;
    job.raw_value = value;
    phases_enter(PHASES_WRITE);
}

void jobs_read(unsigned index, const uint8_t *registers, size_t count) {
    begin(JOB_READ, index, drivers_get(index));
    memcpy(job_reading.registers, registers, count);
    job_reading.count = (uint8_t)count;
    phases_enter(PHASES_READ);
}

void jobs_look_after(unsigned index) {
    begin(JOB_MONITOR, index, drivers_get(index));
    phases_enter(PHASES_READ);
}

// A driver that cannot be asked whether it still knows its threshold of a stall is told it again.
bool jobs_turn_to_next_armed(void) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if ((job.armed & 1u << i) == 0) {
            continue;
        }
        job.armed &= (uint8_t)~(1u << i);
        job.driver = (uint8_t)i;
        turn_to(drivers_get(i));
        job.entry.armed = job.on;
        job.pending = (uint16_t)(job.entry.dirty | 1u << KEPT_TCOOLTHRS);
        if (job.on && !job_knows_resets()) {
            job.pending |= 1u << KEPT_SGTHRS;
        }
        phases_enter(PHASES_WRITE);
        return true;
    }
    return false;
}

// Drivers that have no StallGuard need no arming.
void jobs_arm(uint32_t drivers, bool on) {
    memset(&job, 0, sizeof job);
    job.kind = JOB_ARM;
    job.verify = !blind;
    job.on = on;
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        const driver_t *entry = drivers_get(i);
        if ((drivers & 1u << i) != 0 && entry != NULL && entry->chip == TMC22XX_2209) {
            job.armed |= (uint8_t)(1u << i);
        }
    }
    if (!jobs_turn_to_next_armed()) {
        endings_finish();
    }
}

// ---- Under way ----------------------------------------------------------------------------------

void jobs_step(void) {
    while (job.kind != JOB_NONE) {
        access_state_t state = access_poll();
        if (state == ACCESS_BUSY) {
            return;
        }
        if (state == ACCESS_DONE) {
            phases_go_on();
        } else {
            endings_fail_access();
        }
    }
}

void jobs_cut(unsigned wire) {
    bool under_way = job.kind != JOB_NONE && job.entry.wire == wire;
    access_cut(wire, under_way);
    if (under_way) {
        job.opened = false;
        job.armed = 0;
        job.outcome.fault = OUTCOME_CLOSED;
        job.outcome.partly = false;
        endings_finish();
    }
}

// ---- Of the face --------------------------------------------------------------------------------

bool tmc22xx_busy(void) {
    return job.kind != JOB_NONE;
}

bool tmc22xx_arm_busy(void) {
    return job.kind == JOB_ARM;
}

err_t tmc22xx_result(void) {
    return outcome_raise(endings_of_statement());
}

err_t tmc22xx_arm_result(void) {
    return outcome_raise(endings_of_arm());
}

uint32_t tmc22xx_value(unsigned index) {
    return index < job_reading.count ? job_reading.values[index] : 0;
}

void tmc22xx_give_up(void) {
    bool is_statement = job.kind == JOB_SET_UP || job.kind == JOB_CHANGE || job.kind == JOB_READ;
    if (is_statement && job.phase != PHASES_RESTORE) {
        job.cancelled = true;
        access_cancel();
    }
}

void tmc22xx_verify(bool on) {
    blind = !on;
}

bool tmc22xx_verifies(void) {
    return !blind;
}
