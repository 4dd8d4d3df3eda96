// A datagram on the wire: the pause before it, sending, the answer. Context: main loop.
#include "tmc22xx/exchange.h"

#include "hal/hal.h"
#include "tmc22xx/datagram.h"

// An answer begins at most so many bit times behind the request and is 80 long.
#define QUIET_BITS (HAL_WIRE_REPLY_LATEST_BITS + 80u)

static struct {
    const hal_wire_t *wire;
    uint8_t frame[HAL_WIRE_SEND_MAX];
    uint8_t size;
    uint8_t reg; // that is asked for
    bool on_wire;
    uint64_t wake_us;
    uint64_t free_us; // from when on something may be sent
} exchange;

static void begin(const hal_wire_t *wire, uint8_t size) {
    exchange.wire = wire;
    exchange.size = size;
    exchange.on_wire = false;
    exchange.wake_us = exchange.free_us;
}

void exchange_write(const hal_wire_t *wire, uint8_t address, uint8_t reg, uint32_t value) {
    datagram_write(exchange.frame, address, reg, value);
    begin(wire, DATAGRAM_WRITE_SIZE);
}

void exchange_read(const hal_wire_t *wire, uint8_t address, uint8_t reg) {
    datagram_request(exchange.frame, address, reg);
    exchange.reg = reg;
    begin(wire, DATAGRAM_REQUEST_SIZE);
}

static bool is_request(void) {
    return exchange.size == DATAGRAM_REQUEST_SIZE;
}

static exchange_state_t judge(hal_wire_state_t state, const uint8_t *reply, uint32_t *value) {
    switch (state) {
    case HAL_WIRE_DONE:
        return !is_request() || datagram_reply(reply, exchange.reg, value) ? EXCHANGE_DONE
                                                                           : EXCHANGE_GARBLED;
    case HAL_WIRE_SILENT:
        return EXCHANGE_SILENT;
    case HAL_WIRE_HELD_LOW:
        return EXCHANGE_HELD_LOW;
    case HAL_WIRE_BUSY:
    case HAL_WIRE_GARBLED:
        break;
    }
    return EXCHANGE_GARBLED;
}

static uint32_t quiet_us(void) {
    return EXCHANGE_LATE_US + QUIET_BITS * 1000000u / exchange.wire->baud;
}

exchange_state_t exchange_poll(uint32_t *value) {
    uint64_t now_us = hal_time_us();
    if (now_us < exchange.wake_us) {
        return EXCHANGE_BUSY;
    }
    if (!exchange.on_wire) {
        hal_wire_start(exchange.wire, exchange.frame, exchange.size,
                       is_request() ? DATAGRAM_REPLY_SIZE : 0);
        exchange.on_wire = true;
    }
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    hal_wire_state_t wire = hal_wire_poll(reply, &exchange.wake_us);
    if (wire == HAL_WIRE_BUSY) {
        return EXCHANGE_BUSY;
    }
    exchange_state_t state = judge(wire, reply, value);
    exchange.on_wire = false;
    exchange.free_us = now_us + (state == EXCHANGE_DONE ? EXCHANGE_PAUSE_US : quiet_us());
    return state;
}

uint64_t exchange_wake_us(void) {
    return exchange.wake_us;
}

void exchange_abort(void) {
    if (exchange.on_wire) {
        hal_wire_abort();
        exchange.on_wire = false;
        exchange.free_us = hal_time_us() + quiet_us();
    }
}
