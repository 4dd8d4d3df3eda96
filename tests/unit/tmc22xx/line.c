// Wires with driver chips in memory.
#include "line.h"

#include <string.h>
#include <unity.h>

#include "hal/hal.h"
#include "tmc22xx/tmc22xx.h"

#define GSTAT 0x01
#define IFCNT 0x02
#define NODECONF 0x03
#define IOIN 0x06
#define LATE_MAX 64

line_t line;

static struct {
    hal_wire_t open[8];
    bool busy;
    hal_wire_state_t result;
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    uint64_t end_us;
    // Answers that are still to come, and the one that a chip which is behind will give next.
    struct {
        uint64_t time_us;
        uint8_t tx_gpio;
        uint8_t bytes[HAL_WIRE_REPLY_MAX];
    } late[LATE_MAX];
    size_t late_count;
    uint8_t behind[HAL_WIRE_REPLY_MAX];
    bool has_behind;
} state;

static const char *const fault_names[LINE_FAULTS] = {
    "good",  "lost", "no reply", "bad CRC", "other register", "other master",
    "noise", "half", "late",     "reset",   "reset behind",   "held low",
};

const char *line_fault_name(line_fault_t fault) {
    return fault_names[fault];
}

// ---- The board ----------------------------------------------------------------------------------

uint64_t hal_time_us(void) {
    return line.time_us;
}

void line_reset(void) {
    tmc22xx_close(PINS_NONE);
    tmc22xx_verify(true);
    tmc22xx_monitor(false);
    uint64_t time_us = line.time_us + 1000000;
    memset(&line, 0, sizeof line);
    memset(&state, 0, sizeof state);
    line.time_us = time_us;
}

void line_expect(line_fault_t (*fault)(size_t frame)) {
    line.fault = fault;
    line.frame_count = 0;
}

uint64_t line_run(void) {
    uint64_t begin_us = line.time_us;
    for (unsigned turns = 0; tmc22xx_busy(); turns++) {
        TEST_ASSERT_LESS_THAN_UINT_MESSAGE(100000, turns, "the job does not end");
        uint64_t wake_us = tmc22xx_wake_us();
        line.time_us = wake_us > line.time_us ? wake_us : line.time_us;
        tmc22xx_background();
    }
    return line.time_us - begin_us;
}

void line_run_until(uint64_t time_us) {
    while (tmc22xx_busy() && line.time_us < time_us) {
        uint64_t wake_us = tmc22xx_wake_us();
        wake_us = wake_us > line.time_us ? wake_us : line.time_us;
        line.time_us = wake_us < time_us ? wake_us : time_us;
        tmc22xx_background();
    }
}

// ---- Chips --------------------------------------------------------------------------------------

// A second implementation, bit by bit as the datasheet draws it.
static uint8_t crc(const uint8_t *bytes, size_t size) {
    uint8_t value = 0;
    for (size_t i = 0; i < size; i++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            bool feedback = (value >> 7 & 1) != (bytes[i] >> bit & 1);
            value = (uint8_t)(value << 1);
            value ^= feedback ? 0x07 : 0;
        }
    }
    return value;
}

void line_power_up(line_chip_t *chip) {
    memset(chip->registers, 0, sizeof chip->registers);
    chip->registers[0x00] = 0x101;
    chip->registers[GSTAT] = 1;
    chip->registers[IOIN] = chip->is_2208 ? 0x20000000 : 0x21000000;
    chip->registers[0x11] = 20;
    chip->registers[0x6C] = 0x10000053;
    chip->registers[0x70] = 0xC10D0024;
    chip->ifcnt = 0;
    chip->send_delay = 8;
}

line_chip_t *line_add(uint8_t tx_gpio, uint8_t address) {
    line_chip_t *chip = &line.chips[line.chip_count++];
    chip->tx_gpio = tx_gpio;
    chip->address = address;
    line_power_up(chip);
    return chip;
}

static line_chip_t *find_chip(uint8_t tx_gpio, uint8_t address) {
    for (size_t i = 0; i < line.chip_count; i++) {
        line_chip_t *chip = &line.chips[i];
        if (chip->tx_gpio == tx_gpio && chip->address == address && !chip->gone) {
            return chip;
        }
    }
    return NULL;
}

static void take_write(line_chip_t *chip, const uint8_t *frame) {
    uint8_t reg = frame[2] & 0x7F;
    uint32_t value =
        (uint32_t)frame[3] << 24 | (uint32_t)frame[4] << 16 | (uint32_t)frame[5] << 8 | frame[6];
    if (chip->deaf) {
        return;
    }
    chip->ifcnt++;
    if (reg == GSTAT) {
        chip->registers[GSTAT] &= ~value;
    } else if (reg != IFCNT && reg != IOIN) {
        chip->registers[reg] = value;
    }
    if (reg == NODECONF) {
        chip->send_delay = (uint8_t)(8 * ((value >> 8 & 15) | 1));
    }
}

static void make_reply(const line_chip_t *chip, uint8_t reg, uint8_t *reply) {
    uint32_t value = reg == IFCNT ? chip->ifcnt : chip->registers[reg];
    const uint8_t bytes[] = {0x05,
                             0xFF,
                             reg,
                             (uint8_t)(value >> 24),
                             (uint8_t)(value >> 16),
                             (uint8_t)(value >> 8),
                             (uint8_t)value};
    memcpy(reply, bytes, sizeof bytes);
    reply[7] = crc(bytes, sizeof bytes);
}

// ---- The wire -----------------------------------------------------------------------------------

static uint64_t bits_us(uint64_t bits, uint32_t baud) {
    return bits * 1000000 / baud;
}

bool line_is_open(uint8_t tx_gpio) {
    for (size_t i = 0; i < 8; i++) {
        if (state.open[i].baud != 0 && state.open[i].tx_gpio == tx_gpio) {
            return true;
        }
    }
    return false;
}

void hal_wire_open(const hal_wire_t *wire) {
    TEST_ASSERT_FALSE(line_is_open(wire->tx_gpio));
    size_t i = 0;
    while (state.open[i].baud != 0) {
        i++;
    }
    state.open[i] = *wire;
}

void hal_wire_close(const hal_wire_t *wire) {
    for (size_t i = 0; i < 8; i++) {
        if (state.open[i].tx_gpio == wire->tx_gpio) {
            state.open[i].baud = 0;
        }
    }
}

void hal_wire_abort(void) {
    state.busy = false;
}

static void end_at(uint64_t time_us, hal_wire_state_t result) {
    state.end_us = time_us;
    state.result = result;
}

static void add_late(uint64_t time_us, uint8_t tx_gpio, const uint8_t *bytes) {
    TEST_ASSERT_LESS_THAN_UINT(LATE_MAX, state.late_count);
    state.late[state.late_count].time_us = time_us;
    state.late[state.late_count].tx_gpio = tx_gpio;
    memcpy(state.late[state.late_count].bytes, bytes, HAL_WIRE_REPLY_MAX);
    state.late_count++;
}

static void forget_late(uint64_t before_us) {
    for (size_t i = state.late_count; i-- > 0;) {
        if (state.late[i].time_us < before_us) {
            state.late[i] = state.late[--state.late_count];
        }
    }
}

// Takes a late answer that begins in this time off the list.
static bool take_late(uint8_t tx_gpio, uint64_t from_us, uint64_t to_us, uint64_t *time_us) {
    for (size_t i = 0; i < state.late_count; i++) {
        bool fits = state.late[i].time_us >= from_us && state.late[i].time_us < to_us;
        if (fits && state.late[i].tx_gpio == tx_gpio) {
            *time_us = state.late[i].time_us;
            memcpy(state.reply, state.late[i].bytes, sizeof state.reply);
            state.late[i] = state.late[--state.late_count];
            return true;
        }
    }
    return false;
}

// The answer of a chip, as the fault makes it; false: none comes in time.
static bool answer(line_chip_t *chip, uint8_t reg, line_fault_t fault, uint64_t time_us) {
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    make_reply(chip, reg, reply);
    if (line.behind) {
        uint8_t now[HAL_WIRE_REPLY_MAX];
        memcpy(now, reply, sizeof now);
        memcpy(reply, state.behind, sizeof reply);
        memcpy(state.behind, now, sizeof now);
        bool had = state.has_behind;
        state.has_behind = true;
        memcpy(state.reply, reply, sizeof reply);
        return had;
    }
    switch (fault) {
    case LINE_NO_REPLY:
        return false;
    case LINE_BAD_CRC:
        reply[6 - line.frame_count / 8 % 4] ^= (uint8_t)(1u << line.frame_count % 8);
        break;
    case LINE_OTHER_REG:
        make_reply(chip, reg ^ 0x01, reply);
        break;
    case LINE_OTHER_MASTER:
        reply[1] = 0xFE;
        reply[6] ^= 1;
        reply[7] = crc(reply, 7);
        break;
    case LINE_LATE:
        add_late(time_us + line.late_us, chip->tx_gpio, reply);
        return false;
    default:
        break;
    }
    memcpy(state.reply, reply, sizeof reply);
    return true;
}

static void exchange(const hal_wire_t *wire, const uint8_t *send, size_t size, size_t reply_size,
                     line_fault_t fault) {
    uint64_t sent_us = line.time_us + bits_us(10 * size, wire->baud);
    uint64_t latest_us = sent_us + bits_us(HAL_WIRE_REPLY_LATEST_BITS, wire->baud);
    line_chip_t *chip = find_chip(wire->tx_gpio, send[1]);
    bool collides = false; // with an answer that comes while this is being sent
    uint64_t time_us;
    uint64_t before_us = line.time_us - bits_us(80, wire->baud);
    forget_late(before_us);
    while (take_late(wire->tx_gpio, before_us, sent_us, &time_us)) {
        collides = true;
    }
    if (chip != NULL && fault == LINE_RESET) {
        line_power_up(chip);
    }
    bool damaged = fault == LINE_LOST ||
                   (reply_size == 0 &&
                    (fault == LINE_BAD_CRC || fault == LINE_NO_REPLY || fault == LINE_NOISE));
    bool heard = chip != NULL && !collides && !damaged && crc(send, size - 1) == send[size - 1];
    if (reply_size == 0) {
        if (heard) {
            take_write(chip, send);
        }
        end_at(sent_us, HAL_WIRE_DONE);
    } else if (take_late(wire->tx_gpio, sent_us, latest_us, &time_us)) {
        end_at(time_us + bits_us(80, wire->baud), HAL_WIRE_DONE);
    } else if (heard && answer(chip, send[2], fault, sent_us + bits_us(8, wire->baud))) {
        uint64_t begin_us = sent_us + bits_us(chip->send_delay, wire->baud);
        end_at(begin_us + bits_us(80, wire->baud), HAL_WIRE_DONE);
        state.result = fault == LINE_NOISE ? HAL_WIRE_GARBLED : state.result;
        state.result = fault == LINE_HALF ? HAL_WIRE_SILENT : state.result;
    } else {
        end_at(latest_us + bits_us(90, wire->baud), HAL_WIRE_SILENT);
    }
    if (chip != NULL && fault == LINE_RESET_BEHIND) {
        line_power_up(chip);
    }
}

void hal_wire_start(const hal_wire_t *wire, const uint8_t *send, size_t size, size_t reply_size) {
    TEST_ASSERT_FALSE(state.busy);
    TEST_ASSERT_TRUE(line_is_open(wire->tx_gpio));
    line_fault_t fault = line.fault != NULL ? line.fault(line.frame_count) : LINE_GOOD;
    if (line.frame_count < LINE_FRAMES) {
        line_frame_t *frame = &line.frames[line.frame_count];
        *frame = (line_frame_t){.time_us = line.time_us, .tx_gpio = wire->tx_gpio};
        frame->size = (uint8_t)size;
        memcpy(frame->bytes, send, size);
    }
    line.frame_count++;
    state.busy = true;
    if (fault == LINE_HELD_LOW && reply_size > 0) {
        end_at(line.time_us + bits_us(HAL_WIRE_HELD_BITS, wire->baud), HAL_WIRE_HELD_LOW);
    } else {
        exchange(wire, send, size, reply_size, fault == LINE_HELD_LOW ? LINE_LOST : fault);
    }
}

hal_wire_state_t hal_wire_poll(uint8_t *reply, uint64_t *again_us) {
    TEST_ASSERT_TRUE(state.busy);
    if (line.time_us < state.end_us) {
        *again_us = state.end_us;
        return HAL_WIRE_BUSY;
    }
    state.busy = false;
    memcpy(reply, state.reply, sizeof state.reply);
    return state.result;
}
