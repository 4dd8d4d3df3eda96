// Jobs in phases, each of which is one access or several of a kind. Context: main loop.
//
//   set up, verified    IDENTIFY  STATUS  CLEAR  DELAY   WRITE ...  LOOK
//   set up or change, not verified                       WRITE ...
//   change, verified; arm (for each driver)              WRITE ...  LOOK
//   a register that is not kept                          RAW        LOOK
//   read                                                 READ ...   LOOK
//
// If an access fails and kept registers have been written, RESTORE writes what they were before;
// what cannot be restored is `dirty` and is written first by the next job that changes something.
// If nobody answers to IDENTIFY, KNOCK finds out who else does.
#include "tmc22xx/jobs.h"

#include <string.h>

#include "tmc22xx/access.h"
#include "tmc22xx/monitor.h"
#include "tmc22xx/outcome.h"
#include "tmc22xx/tmc22xx_registers.h"
#include "tmc22xx/wires.h"

#define SEND_DELAY 2 // of an answer: 3 x 8 bit times, for other drivers on the wire to notice

typedef enum { KIND_NONE, KIND_SET_UP, KIND_CHANGE, KIND_READ, KIND_ARM, KIND_MONITOR } kind_t;

typedef enum {
    PHASE_IDENTIFY,
    PHASE_STATUS,
    PHASE_CLEAR,
    PHASE_DELAY,
    PHASE_WRITE,
    PHASE_RAW,
    PHASE_READ,
    PHASE_LOOK,
    PHASE_RESTORE,
    PHASE_KNOCK
} phase_t;

static struct {
    uint8_t kind, phase;
    uint8_t driver; // in the table; DRIVERS_NONE: a new one
    bool verify;
    bool on;     // KIND_ARM
    bool opened; // the wire, for this job
    bool cancelled;
    bool has_raw;     // a register beside the kept ones is still to be written
    uint8_t raw_reg;  // its address
    uint8_t armed;    // KIND_ARM: drivers still to come, as bits
    uint8_t next;     // register to be read, or address to be asked
    uint8_t writing;  // kept register on the wire
    uint16_t pending; // kept registers to be written, as bits
    uint16_t touched; // those that were sent
    uint32_t raw_value;
    driver_t entry; // what the driver will be
    outcome_t outcome;
} job;

static struct {
    uint8_t registers[TMC22XX_READS];
    uint8_t count;
    uint32_t values[TMC22XX_READS];
} reading;

static uint32_t look[2]; // of the monitor: GSTAT, DRV_STATUS
static outcome_t statement_outcome, arm_outcome;
static bool blind; // nothing is verified

static const uint8_t look_registers[] = {TMC22XX_REG_GSTAT, TMC22XX_REG_DRV_STATUS};

static void enter(phase_t phase);
static bool turn_to_next_armed(void);

static driver_t *driver(void) {
    return drivers_get(job.driver);
}

// ---- The end ------------------------------------------------------------------------------------

static void finish(void) {
    if (job.kind == KIND_ARM) {
        arm_outcome = job.outcome;
    } else if (job.kind != KIND_MONITOR) {
        statement_outcome = job.outcome;
    }
    job.kind = KIND_NONE;
    if (job.opened && !drivers_on(job.entry.wire)) {
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

static void commit(void) {
    job.entry.dirty = 0;
    note_way(&job.entry);
    if (job.kind == KIND_SET_UP) {
        job.entry.listens = job.verify;
        job.entry.conditions = job.entry.told = 0;
        job.driver = job.driver == DRIVERS_NONE ? (uint8_t)drivers_free() : job.driver;
    }
    drivers_put(job.driver, &job.entry);
}

static void succeed(void) {
    if (job.kind == KIND_READ || job.kind == KIND_MONITOR) {
        note_way(driver());
    } else {
        commit();
    }
    if (job.verify) {
        monitor_note_answer(driver());
    }
    if (job.kind == KIND_MONITOR) {
        monitor_note(driver(), look[0], look[1]);
    }
    if (job.kind != KIND_ARM || !turn_to_next_armed()) {
        finish();
    }
}

// ---- Failures -----------------------------------------------------------------------------------

// Whoever disarms wants it for all drivers.
static void give_driver_up(void) {
    if (job.kind != KIND_ARM || job.on || !turn_to_next_armed()) {
        finish();
    }
}

static void note_failure(driver_t *entry, uint8_t fault) {
    note_way(entry);
    entry->failures = (uint16_t)(entry->failures + (fault != ACCESS_CANCELLED));
    entry->dirty |= job.touched;
    monitor_note_failure(entry, fault, job.kind == KIND_MONITOR);
    if (job.kind == KIND_ARM && job.touched != 0) {
        entry->armed |= job.on; // perhaps; disarming will tell
    }
}

static bool can_restore(uint8_t fault) {
    return driver() != NULL && job.touched != 0 && job.kind != KIND_ARM && fault != ACCESS_LOST;
}

static void fail(uint8_t fault) {
    if (job.outcome.fault == ACCESS_OK) {
        job.outcome.fault = fault;
    }
    if (driver() != NULL) {
        note_failure(driver(), fault);
    }
    job.outcome.partly = job.touched != 0 && job.kind != KIND_ARM && fault != ACCESS_LOST;
    if (job.kind == KIND_SET_UP && job.phase == PHASE_IDENTIFY && fault == ACCESS_SILENT) {
        job.next = 0;
        enter(PHASE_KNOCK);
    } else if (can_restore(fault)) {
        job.entry = *driver();
        job.pending = job.touched;
        enter(PHASE_RESTORE);
    } else {
        give_driver_up();
    }
}

static void fail_access(void) {
    switch ((phase_t)job.phase) {
    case PHASE_LOOK:
        if (job.kind == KIND_READ) { // what was wanted is there
            succeed();
            return;
        }
        break;
    case PHASE_RESTORE:
        finish(); // what is left stays dirty
        return;
    case PHASE_KNOCK:
        job.next++;
        enter(PHASE_KNOCK);
        return;
    default:
        break;
    }
    if (job.phase == PHASE_WRITE && access_is_in_doubt()) {
        job.touched |= (uint16_t)(1u << job.writing);
    }
    fail((uint8_t)access_fault());
}

// ---- Phases -------------------------------------------------------------------------------------

// With a verified driver a flag that was cleared when it was set up tells whether it was reset.
static bool knows_resets(void) {
    return job.verify && (job.kind == KIND_SET_UP || driver()->listens);
}

static void end_writing(void) {
    if (job.has_raw) {
        enter(PHASE_RAW);
    } else if (knows_resets()) {
        enter(PHASE_LOOK);
    } else {
        succeed();
    }
}

// From the coarse range of current to the fine one the range goes first, so that the current is
// never above both.
static bool range_goes_first(void) {
    return driver() != NULL && TMC22XX_TAKE(job.entry.kept[KEPT_CHOPCONF], CHOPCONF, vsense) != 0 &&
           TMC22XX_TAKE(driver()->kept[KEPT_CHOPCONF], CHOPCONF, vsense) == 0;
}

static uint8_t next_pending(void) {
    if ((job.pending >> KEPT_CHOPCONF & 1u) != 0 && range_goes_first()) {
        return KEPT_CHOPCONF;
    }
    uint8_t kept = 0;
    while ((job.pending >> kept & 1u) == 0) {
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
    } else {
        end_writing();
    }
}

static void end_write(void) {
    job.pending &= (uint16_t)~(1u << job.writing);
    job.touched |= (uint16_t)(1u << job.writing);
    enter(PHASE_WRITE);
}

static void begin_restore(void) {
    if (job.pending != 0) {
        write_next();
        return;
    }
    job.outcome.partly = false;
    finish();
}

static void end_restore(void) {
    job.pending &= (uint16_t)~(1u << job.writing);
    driver()->dirty &= (uint16_t)~(1u << job.writing);
    enter(PHASE_RESTORE);
}

static void begin_identify(void) {
    access_read(TMC22XX_REG_IOIN);
}

static void end_identify(void) {
    uint32_t version = TMC22XX_TAKE(access_value(), IOIN, VERSION);
    if (version != (job.entry.chip == TMC22XX_2208 ? TMC22XX_VERSION_2208 : TMC22XX_VERSION_2209)) {
        job.outcome.found = (uint8_t)version;
        fail(OUTCOME_WRONG_CHIP);
        return;
    }
    enter(PHASE_STATUS);
}

static void read_gstat(void) {
    access_read(TMC22XX_REG_GSTAT);
}

// The flag of a reset may have been cleared by a set-up that failed behind that.
static bool was_reset(uint32_t gstat) {
    return TMC22XX_TAKE(gstat, GSTAT, reset) != 0 ||
           (driver() != NULL && (driver()->conditions & DRIVERS_LOST) != 0);
}

// After power-up what was written later than the set-up is gone; if there was no power-up,
// registers of a driver that is new here may have been written in an earlier life of ours.
static void end_status(void) {
    bool reset = was_reset(access_value());
    if (reset && driver() != NULL) {
        driver()->conditions |= DRIVERS_LOST;
        driver()->told |= DRIVERS_LOST; // it is being mended
    }
    for (unsigned i = 0; i < KEPT_COUNT; i++) {
        bool is_later = (KEPT_LATER >> i & 1u) != 0;
        bool is_wanted = driver() == NULL ? !reset : reset && drivers_wanted(&job.entry, i) != 0;
        if (is_later && is_wanted) {
            job.pending |= (uint16_t)(1u << i);
        }
    }
    job.pending &= (uint16_t)drivers_has(&job.entry, job.pending);
    enter(access_value() != 0 ? PHASE_CLEAR : PHASE_DELAY);
}

// Clears the flags that were seen and no others: a reset from now on is to be found at the end.
static void begin_clear(void) {
    access_write(TMC22XX_REG_GSTAT, access_value(), true);
}

static void end_clear(void) {
    enter(PHASE_DELAY);
}

static void begin_delay(void) {
    access_write(TMC22XX_REG_NODECONF, TMC22XX_BITS(NODECONF, SENDDELAY, SEND_DELAY), true);
}

static void end_delay(void) {
    enter(PHASE_WRITE);
}

static void begin_raw(void) {
    job.has_raw = false;
    access_write(job.raw_reg, job.raw_value, job.verify);
}

// Whoever clears the flag of a reset himself says that the settings are well.
static void end_raw(void) {
    if (job.raw_reg == TMC22XX_REG_GSTAT && TMC22XX_TAKE(job.raw_value, GSTAT, reset) != 0) {
        driver()->conditions &= (uint8_t)~DRIVERS_LOST;
        job.entry.conditions = driver()->conditions;
    }
    end_writing();
}

static void begin_read(void) {
    access_read(job.kind == KIND_MONITOR ? look_registers[job.next] : reading.registers[job.next]);
}

static void end_read(void) {
    bool monitor = job.kind == KIND_MONITOR;
    (monitor ? look : reading.values)[job.next++] = access_value();
    if (job.next < (monitor ? COUNT_OF_ARRAY(look) : reading.count)) {
        enter(PHASE_READ);
    } else if (!monitor && knows_resets()) {
        enter(PHASE_LOOK);
    } else {
        succeed();
    }
}

static void end_look(void) {
    bool reset = job.kind == KIND_SET_UP ? TMC22XX_TAKE(access_value(), GSTAT, reset) != 0
                                         : was_reset(access_value());
    if (reset && job.kind == KIND_READ) {
        driver()->conditions |= DRIVERS_LOST; // told as the monitor's
    }
    if (reset && job.kind != KIND_READ) {
        fail(ACCESS_LOST);
    } else {
        succeed();
    }
}

// Asks the other addresses of the wire that no driver is known at.
static void begin_knock(void) {
    while (job.next < TMC22XX_ADDRESSES && (job.next == job.entry.address ||
                                            drivers_at(job.entry.wire, job.next) != DRIVERS_NONE)) {
        job.next++;
    }
    if (job.next == TMC22XX_ADDRESSES || job.cancelled) {
        finish();
        return;
    }
    access_turn_to(job.entry.wire, job.next, false);
    access_knock();
}

static void end_knock(void) {
    job.outcome.found |= (uint8_t)(1u << job.next++);
    enter(PHASE_KNOCK);
}

static const struct {
    void (*begin)(void);
    void (*end)(void);
} phases[] = {
    [PHASE_IDENTIFY] = {begin_identify, end_identify},
    [PHASE_STATUS] = {read_gstat, end_status},
    [PHASE_CLEAR] = {begin_clear, end_clear},
    [PHASE_DELAY] = {begin_delay, end_delay},
    [PHASE_WRITE] = {begin_write, end_write},
    [PHASE_RAW] = {begin_raw, end_raw},
    [PHASE_READ] = {begin_read, end_read},
    [PHASE_LOOK] = {read_gstat, end_look},
    [PHASE_RESTORE] = {begin_restore, end_restore},
    [PHASE_KNOCK] = {begin_knock, end_knock},
};

static void enter(phase_t phase) {
    job.phase = (uint8_t)phase;
    phases[phase].begin();
}

// ---- Beginnings ---------------------------------------------------------------------------------

static void turn_to(const driver_t *entry) {
    job.entry = *entry;
    job.touched = 0;
    if (job.outcome.fault == ACCESS_OK) {
        job.outcome = (outcome_t){
            .tx_gpio = wires_get(entry->wire)->tx_gpio,
            .address = entry->address,
            .axis = entry->axis,
            .chip = entry->chip,
            .is_being_set = job.kind == KIND_SET_UP,
        };
    }
    access_turn_to(entry->wire, entry->address, knows_resets());
}

static void begin(kind_t kind, unsigned index, const driver_t *entry) {
    memset(&job, 0, sizeof job);
    job.kind = (uint8_t)kind;
    job.driver = (uint8_t)index;
    job.verify = !blind;
    turn_to(entry);
}

void jobs_set_up(unsigned index, const driver_t *entry, bool opened) {
    begin(KIND_SET_UP, index, entry);
    job.opened = opened;
    job.pending = KEPT_SET_UP | entry->dirty;
    enter(job.verify ? PHASE_IDENTIFY : PHASE_WRITE);
}

void jobs_change(unsigned index, const driver_t *entry, uint32_t kept) {
    begin(KIND_CHANGE, index, entry);
    job.pending = (uint16_t)(kept | entry->dirty);
    enter(PHASE_WRITE);
}

void jobs_write(unsigned index, uint8_t reg, uint32_t value) {
    begin(KIND_CHANGE, index, drivers_get(index));
    job.pending = job.entry.dirty;
    job.has_raw = true;
    job.raw_reg = reg;
    job.raw_value = value;
    enter(PHASE_WRITE);
}

void jobs_read(unsigned index, const uint8_t *registers, size_t count) {
    begin(KIND_READ, index, drivers_get(index));
    memcpy(reading.registers, registers, count);
    reading.count = (uint8_t)count;
    enter(PHASE_READ);
}

void jobs_look_after(unsigned index) {
    begin(KIND_MONITOR, index, drivers_get(index));
    enter(PHASE_READ);
}

// A driver that cannot be asked whether it still knows its threshold of a stall is told it again.
static bool turn_to_next_armed(void) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if ((job.armed >> i & 1u) == 0) {
            continue;
        }
        job.armed &= (uint8_t)~(1u << i);
        job.driver = (uint8_t)i;
        turn_to(drivers_get(i));
        job.entry.armed = job.on;
        job.pending = (uint16_t)(job.entry.dirty | 1u << KEPT_TCOOLTHRS);
        if (job.on && !knows_resets()) {
            job.pending |= 1u << KEPT_SGTHRS;
        }
        enter(PHASE_WRITE);
        return true;
    }
    return false;
}

// Drivers that have no StallGuard need no arming.
void jobs_arm(uint32_t drivers, bool on) {
    memset(&job, 0, sizeof job);
    job.kind = KIND_ARM;
    job.verify = !blind;
    job.on = on;
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        const driver_t *entry = drivers_get(i);
        if ((drivers >> i & 1u) != 0 && entry != NULL && entry->chip == TMC22XX_2209) {
            job.armed |= (uint8_t)(1u << i);
        }
    }
    if (!turn_to_next_armed()) {
        finish();
    }
}

// ---- Under way ----------------------------------------------------------------------------------

bool jobs_busy(void) {
    return job.kind != KIND_NONE;
}

bool jobs_arm_busy(void) {
    return job.kind == KIND_ARM;
}

void jobs_step(void) {
    while (job.kind != KIND_NONE) {
        access_state_t state = access_poll();
        if (state == ACCESS_BUSY) {
            return;
        }
        if (state == ACCESS_DONE) {
            phases[job.phase].end();
        } else {
            fail_access();
        }
    }
}

void jobs_give_up(void) {
    bool is_statement = job.kind == KIND_SET_UP || job.kind == KIND_CHANGE || job.kind == KIND_READ;
    if (is_statement && job.phase != PHASE_RESTORE) {
        job.cancelled = true;
        access_cancel();
    }
}

void jobs_cut(unsigned wire) {
    bool under_way = job.kind != KIND_NONE && job.entry.wire == wire;
    access_cut(wire, under_way);
    if (under_way) {
        job.opened = false;
        job.armed = 0;
        job.outcome.fault = OUTCOME_CLOSED;
        job.outcome.partly = false;
        finish();
    }
}

// ---- Results ------------------------------------------------------------------------------------

err_t jobs_raise(void) {
    return outcome_raise(&statement_outcome);
}

err_t jobs_raise_arm(void) {
    return outcome_raise(&arm_outcome);
}

uint32_t jobs_value(unsigned index) {
    return index < reading.count ? reading.values[index] : 0;
}

void jobs_verify(bool on) {
    blind = !on;
}

bool jobs_verifies(void) {
    return !blind;
}
