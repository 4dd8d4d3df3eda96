// The phases of jobs. Context: main loop.
#include "tmc22xx/phases.h"

#include "tmc22xx/access.h"
#include "tmc22xx/endings.h"
#include "tmc22xx/job.h"
#include "tmc22xx/monitor.h"
#include "tmc22xx/tmc22xx_registers.h"

#define SEND_DELAY 2 // of an answer: 3 x 8 bit times, for other drivers on the wire to notice

// ---- Writing ------------------------------------------------------------------------------------

// What the job wanted is done; if the driver was reset meanwhile that was for nothing.
static void look_for_reset(void) {
    if (job_knows_resets()) {
        phases_enter(PHASES_LOOK);
    } else {
        endings_succeed();
    }
}

// From the coarse range of current to the fine one the range goes first, so that the current is
// never above both.
static bool range_goes_first(void) {
    return job_driver() != NULL &&
           TMC22XX_TAKE(job.entry.kept[KEPT_CHOPCONF], CHOPCONF, vsense) != 0 &&
           TMC22XX_TAKE(job_driver()->kept[KEPT_CHOPCONF], CHOPCONF, vsense) == 0;
}

static uint8_t next_pending(void) {
    if ((job.pending & 1u << KEPT_CHOPCONF) != 0 && range_goes_first()) {
        return KEPT_CHOPCONF;
    }
    uint8_t kept = 0;
    while ((job.pending & 1u << kept) == 0) {
        kept++;
    }
    return kept;
}

static void write_next(void) {
    job.writing = next_pending();
    access_write(drivers_register(job.writing), drivers_wanted(&job.entry, job.writing),
                 job.verify);
}

static void begin_write(void) {
    if (job.pending != 0) {
        write_next();
    } else if (job.has_raw) {
        phases_enter(PHASES_RAW);
    } else {
        look_for_reset();
    }
}

static void end_write(void) {
    job.pending &= (uint16_t)~(1u << job.writing);
    job.touched |= (uint16_t)(1u << job.writing);
    phases_enter(PHASES_WRITE);
}

static void begin_restore(void) {
    if (job.pending != 0) {
        write_next();
        return;
    }
    job.outcome.partly = false;
    endings_finish();
}

static void end_restore(void) {
    job.pending &= (uint16_t)~(1u << job.writing);
    job_driver()->dirty &= (uint16_t)~(1u << job.writing);
    phases_enter(PHASES_RESTORE);
}

static void begin_identify(void) {
    access_read(TMC22XX_REG_IOIN);
}

static void end_identify(void) {
    uint32_t version = TMC22XX_TAKE(access_value(), IOIN, VERSION);
    if (version != (job.entry.chip == TMC22XX_2208 ? TMC22XX_VERSION_2208 : TMC22XX_VERSION_2209)) {
        job.outcome.found = (uint8_t)version;
        endings_fail(OUTCOME_WRONG_CHIP);
        return;
    }
    phases_enter(PHASES_STATUS);
}

static void read_gstat(void) {
    access_read(TMC22XX_REG_GSTAT);
}

// The flag of a reset may have been cleared by a set-up that failed behind that.
static bool was_reset(uint32_t gstat) {
    return TMC22XX_TAKE(gstat, GSTAT, reset) != 0 ||
           (job_driver() != NULL && (job_driver()->conditions & DRIVERS_LOST) != 0);
}

// After power-up what was written later than the set-up is gone; if there was no power-up,
// registers of a driver that is new here may have been written in an earlier life of ours.
static void end_status(void) {
    bool reset = was_reset(access_value());
    if (reset && job_driver() != NULL) {
        job_driver()->conditions |= DRIVERS_LOST;
        job_driver()->told |= DRIVERS_LOST; // it is being mended
    }
    for (unsigned i = 0; i < KEPT_COUNT; i++) {
        bool is_later = (KEPT_LATER >> i & 1u) != 0;
        bool is_wanted =
            job_driver() == NULL ? !reset : reset && drivers_wanted(&job.entry, i) != 0;
        if (is_later && is_wanted) {
            job.pending |= (uint16_t)(1u << i);
        }
    }
    job.pending &= (uint16_t)drivers_has(&job.entry, job.pending);
    phases_enter(access_value() != 0 ? PHASES_CLEAR : PHASES_DELAY);
}

// Clears the flags that were seen and no others: a reset from now on is to be found at the end.
static void begin_clear(void) {
    access_write(TMC22XX_REG_GSTAT, access_value(), true);
}

static void end_clear(void) {
    phases_enter(PHASES_DELAY);
}

static void begin_delay(void) {
    access_write(TMC22XX_REG_NODECONF, TMC22XX_BITS(NODECONF, SENDDELAY, SEND_DELAY), true);
}

static void end_delay(void) {
    phases_enter(PHASES_WRITE);
}

static void begin_raw(void) {
    access_write(job.raw_reg, job.raw_value, job.verify);
}

// Whoever clears the flag of a reset himself says that the settings are well.
static void end_raw(void) {
    if (job.raw_reg == TMC22XX_REG_GSTAT && TMC22XX_TAKE(job.raw_value, GSTAT, reset) != 0) {
        job_driver()->conditions &= (uint8_t)~DRIVERS_LOST;
    }
    look_for_reset();
}

static void begin_read(void) {
    static const uint8_t look[COUNT_OF_ARRAY(job.look)] = {TMC22XX_REG_GSTAT,
                                                           TMC22XX_REG_DRV_STATUS};
    access_read((job.kind == JOB_MONITOR ? look : job_reading.registers)[job.next]);
}

static void end_read(void) {
    bool monitor = job.kind == JOB_MONITOR;
    (monitor ? job.look : job_reading.values)[job.next++] = access_value();
    if (job.next < (monitor ? COUNT_OF_ARRAY(job.look) : job_reading.count)) {
        phases_enter(PHASES_READ);
    } else if (monitor) { // it has looked
        endings_succeed();
    } else {
        look_for_reset();
    }
}

static void end_look(void) {
    bool reset = job.kind == JOB_SET_UP ? TMC22XX_TAKE(access_value(), GSTAT, reset) != 0
                                        : was_reset(access_value());
    if (reset && job.kind == JOB_READ) {
        monitor_note_reset(job_driver());
    }
    if (reset && job.kind != JOB_READ) {
        endings_fail(ACCESS_LOST);
    } else {
        endings_succeed();
    }
}

// Asks the other addresses of the wire.
static void begin_knock(void) {
    job.next = (uint8_t)(job.next + (job.next == job.entry.address));
    if (job.next >= TMC22XX_ADDRESSES || job.cancelled) {
        endings_finish();
        return;
    }
    access_turn_to(job.entry.wire, job.next, false);
    access_knock();
}

static void end_knock(void) {
    if (drivers_at(job.entry.wire, job.next) != DRIVERS_NONE) {
        job.outcome.others = true;
    } else {
        job.outcome.found |= (uint8_t)(1u << job.next);
    }
    job.next++;
    phases_enter(PHASES_KNOCK);
}

static const struct {
    void (*begin)(void);
    void (*end)(void);
} steps[] = {
    [PHASES_IDENTIFY] = {begin_identify, end_identify},
    [PHASES_STATUS] = {read_gstat, end_status},
    [PHASES_CLEAR] = {begin_clear, end_clear},
    [PHASES_DELAY] = {begin_delay, end_delay},
    [PHASES_WRITE] = {begin_write, end_write},
    [PHASES_RAW] = {begin_raw, end_raw},
    [PHASES_READ] = {begin_read, end_read},
    [PHASES_LOOK] = {read_gstat, end_look},
    [PHASES_RESTORE] = {begin_restore, end_restore},
    [PHASES_KNOCK] = {begin_knock, end_knock},
};

void phases_enter(phases_t phase) {
    job.phase = (uint8_t)phase;
    steps[phase].begin();
}

void phases_go_on(void) {
    steps[job.phase].end();
}
