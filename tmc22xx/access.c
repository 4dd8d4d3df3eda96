// Reading and writing with repeats. Context: main loop.
//
//   reading:   [another register until one is answered, if the wire is not trusted] the register
//   writing:   [IFCNT] write, IFCNT - counted? - else the write again
//                             `- something else? GSTAT: a reset?
//
// From 255 the count goes on to 0, which may also be a reset at the wrong time. Whoever writes
// looks for the flag of a reset when all is written, and finds it then.
#include "tmc22xx/access.h"

#include "base/base.h"
#include "tmc22xx/exchange.h"
#include "tmc22xx/tmc22xx_registers.h"
#include "tmc22xx/wires.h"

typedef enum {
    STAGE_VALUE, // reads what was asked for
    STAGE_BASE,  // IFCNT before the first write
    STAGE_SEND,  // the write is on the wire
    STAGE_CHECK, // IFCNT behind it
    STAGE_LOOK,  // GSTAT
    STAGE_KNOCK
} stage_t;

static struct {
    uint8_t wire, address;
    uint8_t reg;
    bool verify;
    uint32_t value;
    stage_t stage;
    access_fault_t fault;
    // Reading, as a part of all stages but STAGE_SEND.
    uint8_t asked;    // register
    uint8_t failures; // in this stage
    bool probing;     // another register is on the wire
    uint8_t writes;   // sent in this access
    bool in_doubt;    // the last of them may have been taken
    bool counted;     // `count` is known
    uint8_t count;    // IFCNT
    uint8_t found;    // IFCNT behind the write
    bool knows_resets;
    bool cancelled;
    uint16_t repeats;
} access;

static uint32_t untrusted; // wires, as bits
static uint8_t next_probe;

// Can be read from both chips, any number of times.
static const uint8_t probes[] = {TMC22XX_REG_IOIN, TMC22XX_REG_GCONF, TMC22XX_REG_CHOPCONF,
                                 TMC22XX_REG_PWMCONF};

// ---- Requests -----------------------------------------------------------------------------------

static bool is_trusted(void) {
    return (untrusted >> access.wire & 1) == 0;
}

static void trust(bool is) {
    uint32_t bit = 1u << access.wire;
    untrusted = is ? untrusted & ~bit : untrusted | bit;
}

static uint8_t take_probe(void) {
    uint8_t reg = probes[next_probe++ % COUNT_OF_ARRAY(probes)];
    return reg != access.asked ? reg : probes[next_probe++ % COUNT_OF_ARRAY(probes)];
}

static void ask(void) {
    access.probing = !is_trusted();
    exchange_read(wires_get(access.wire), access.address,
                  access.probing ? take_probe() : access.asked);
}

static void begin_reading(stage_t stage, uint8_t reg) {
    access.stage = stage;
    access.asked = reg;
    access.failures = 0;
    ask();
}

static access_state_t fail(access_fault_t fault) {
    access.fault = fault;
    return ACCESS_FAILED;
}

// An answer that was missing does not tell more than one that was wrong.
static void note(exchange_state_t state) {
    if (state == EXCHANGE_HELD_LOW) {
        access.fault = ACCESS_HELD_LOW;
        return; // nothing was asked, so nothing is outstanding
    }
    trust(false);
    if (access.fault != ACCESS_GARBLED) {
        access.fault = state == EXCHANGE_GARBLED ? ACCESS_GARBLED : ACCESS_SILENT;
    }
}

// Reads on after an exchange. ACCESS_DONE: the register asked for is in *value.
static access_state_t read_on(exchange_state_t state) {
    if (state != EXCHANGE_DONE) {
        note(state);
        if (++access.failures > ACCESS_REPEATS) {
            return ACCESS_FAILED;
        }
        access.repeats++;
        ask();
        return ACCESS_BUSY;
    }
    access.fault = ACCESS_OK;
    if (access.probing) {
        trust(true);
        ask();
        return ACCESS_BUSY;
    }
    return ACCESS_DONE;
}

// ---- Writing ------------------------------------------------------------------------------------

static void send(void) {
    access.stage = STAGE_SEND;
    access.writes++;
    access.in_doubt = true;
    exchange_write(wires_get(access.wire), access.address, access.reg, access.value);
}

static access_state_t send_again(void) {
    access.count = access.found;
    if (access.writes > ACCESS_REPEATS) {
        return fail(ACCESS_NOT_TAKEN);
    }
    access.repeats++;
    send();
    return ACCESS_BUSY;
}

static access_state_t judge_count(uint32_t value) {
    access.found = (uint8_t)value;
    if (access.found == access.count) {
        access.in_doubt = false;
        return send_again();
    }
    if (access.found == (uint8_t)(access.count + 1u)) {
        access.count = access.found;
        return ACCESS_DONE;
    }
    if (!access.knows_resets) {
        return send_again();
    }
    begin_reading(STAGE_LOOK, TMC22XX_REG_GSTAT);
    return ACCESS_BUSY;
}

// Whoever clears the flag of a reset expects it to be set.
static access_state_t judge_reset(uint32_t gstat) {
    bool reset = TMC22XX_TAKE(gstat, GSTAT, reset) != 0;
    if (reset && access.reg != TMC22XX_REG_GSTAT) {
        return fail(ACCESS_LOST);
    }
    return send_again();
}

// A register has been read in a stage of the access.
static access_state_t judge(uint32_t value) {
    switch (access.stage) {
    case STAGE_BASE:
        access.count = (uint8_t)value;
        access.counted = true;
        send();
        return ACCESS_BUSY;
    case STAGE_CHECK:
        return judge_count(value);
    case STAGE_LOOK:
        return judge_reset(value);
    case STAGE_VALUE:
    case STAGE_SEND:
    case STAGE_KNOCK:
        break;
    }
    access.value = value;
    return ACCESS_DONE;
}

static access_state_t sent(exchange_state_t state) {
    if (state != EXCHANGE_DONE) {
        note(state);
        return ACCESS_FAILED;
    }
    if (!access.verify) {
        return ACCESS_DONE;
    }
    begin_reading(STAGE_CHECK, TMC22XX_REG_IFCNT);
    return ACCESS_BUSY;
}

// ---- The face -----------------------------------------------------------------------------------

void access_turn_to(unsigned wire, uint8_t address, bool knows_resets) {
    access.wire = (uint8_t)wire;
    access.address = address;
    access.knows_resets = knows_resets;
    access.counted = false;
    access.repeats = 0; // those for another driver, which nobody took
}

static void begin(uint8_t reg, uint32_t value) {
    access.reg = reg;
    access.value = value;
    access.fault = ACCESS_OK;
    access.writes = 0;
    access.in_doubt = false;
    access.cancelled = false;
}

void access_read(uint8_t reg) {
    begin(reg, 0);
    begin_reading(STAGE_VALUE, reg);
}

void access_write(uint8_t reg, uint32_t value, bool verify) {
    begin(reg, value);
    access.verify = verify;
    if (verify && !access.counted) {
        begin_reading(STAGE_BASE, TMC22XX_REG_IFCNT);
    } else {
        send();
    }
}

void access_knock(void) {
    begin(0xFF, 0);
    access.stage = STAGE_KNOCK;
    access.asked = 0xFF;
    trust(false);
    ask();
}

// The answer of a knock is for a register that was asked for in turn: no older one passes for it.
static access_state_t knocked(exchange_state_t state) {
    if (state == EXCHANGE_DONE) {
        trust(true);
        return ACCESS_DONE;
    }
    note(state);
    return ACCESS_FAILED;
}

static access_state_t step(exchange_state_t state, uint32_t value) {
    if (access.cancelled) {
        if (state != EXCHANGE_DONE) {
            note(state);
        }
        return fail(ACCESS_CANCELLED);
    }
    if (access.stage == STAGE_SEND) {
        return sent(state);
    }
    if (access.stage == STAGE_KNOCK) {
        return knocked(state);
    }
    access_state_t read = read_on(state);
    return read == ACCESS_DONE ? judge(value) : read;
}

access_state_t access_poll(void) {
    for (;;) {
        uint32_t value = 0;
        exchange_state_t exchange = exchange_poll(&value);
        if (exchange == EXCHANGE_BUSY) {
            return ACCESS_BUSY;
        }
        access_state_t state = step(exchange, value);
        if (state == ACCESS_FAILED) {
            access.counted = false; // nobody knows whether the write has arrived
        }
        if (state != ACCESS_BUSY) {
            return state;
        }
    }
}

uint32_t access_value(void) {
    return access.value;
}

access_fault_t access_fault(void) {
    return access.fault;
}

bool access_is_in_doubt(void) {
    return access.in_doubt;
}

unsigned access_take_repeats(void) {
    unsigned repeats = access.repeats;
    access.repeats = 0;
    return repeats;
}

bool access_count(uint8_t *count) {
    *count = access.count;
    return access.counted;
}

void access_cancel(void) {
    access.cancelled = true;
}

void access_cut(unsigned wire, bool under_way) {
    if (under_way) {
        exchange_abort();
    }
    untrusted &= ~(1u << wire); // when it opens again it has been quiet
}
