// Serial wires as the board's state machine works them: sends a frame bit by bit, then samples each
// byte of the reply from its own start edge. Context: main; host_wire_edges() any.
#include "host_wire.h"

#include <string.h>

#include "hal/hal.h"
#include "hal/hal_wire.h"
#include "host_clock.h"
#include "simulate_wire.h"

#define STOP_BIT 8u // behind the start bit

typedef enum {
    PHASE_NONE,
    PHASE_LISTEN,  // until the line has been idle for long enough
    PHASE_SEND,    // bit `bit` is next
    PHASE_AWAIT,   // a start edge
    PHASE_RECEIVE, // bit `bit` of byte `count` is next
    PHASE_OVER
} phase_t;

static struct {
    hal_wire_t wire;
    phase_t phase;
    simulate_wire_words_t words; // what is sent
    uint8_t reply[HAL_WIRE_REPLY_MAX];
    size_t reply_size, count; // bytes expected and taken
    unsigned bit;
    uint64_t begin_ns; // the bits are counted from here
    uint64_t next_ns;  // something is to be done
    uint64_t held_ns, give_up_ns, ready_ns;
    bool garbled;
} exchange;

static uint64_t bits_ns(uint64_t bits) {
    return (bits * 1000000000u + exchange.wire.baud / 2) / exchange.wire.baud;
}

static bool is_high(unsigned gpio) {
    return (hal_pins_read() & pins_mask(gpio)) != 0;
}

// ---- Sending ------------------------------------------------------------------------------------

static void drive(bool level) {
    uint32_t mask = pins_mask(exchange.wire.tx_gpio);
    if (level) {
        hal_pins_set(mask);
    } else {
        hal_pins_clear(mask);
    }
    simulate_wire_level(exchange.wire.tx_gpio, level);
}

static void let_go(unsigned tx_gpio) {
    hal_pin_input(tx_gpio, HAL_PULL_UP);
    simulate_wire_level(tx_gpio, true);
}

static void begin_sending(uint64_t now_ns) {
    hal_pin_output(exchange.wire.tx_gpio, true);
    simulate_wire_level(exchange.wire.tx_gpio, true);
    exchange.phase = PHASE_SEND;
    exchange.bit = 0;
    exchange.begin_ns = now_ns + bits_ns(HAL_WIRE_TAKE_BITS);
    exchange.next_ns = exchange.begin_ns;
    exchange.words.start_ns = exchange.begin_ns;
}

static void listen_from(uint64_t now_ns, bool high) {
    exchange.next_ns = high ? now_ns + bits_ns(HAL_WIRE_IDLE_BITS) : HOST_CLOCK_NEVER;
}

// ---- Receiving ----------------------------------------------------------------------------------

static void start_byte(uint64_t edge_ns) {
    exchange.phase = PHASE_RECEIVE;
    exchange.bit = 0;
    exchange.begin_ns = edge_ns;
    exchange.next_ns = edge_ns + (bits_ns(1) + bits_ns(2)) / 2;
}

static void await_byte(uint64_t now_ns) {
    exchange.phase = PHASE_AWAIT;
    exchange.next_ns = HOST_CLOCK_NEVER;
    if (!is_high(exchange.wire.rx_gpio)) {
        start_byte(now_ns);
    }
}

static void take_bit(uint64_t now_ns) {
    bool high = is_high(exchange.wire.rx_gpio);
    if (exchange.bit == STOP_BIT) {
        exchange.garbled |= !high;
        if (++exchange.count < exchange.reply_size) {
            await_byte(now_ns);
        } else {
            exchange.phase = PHASE_OVER;
            exchange.next_ns = HOST_CLOCK_NEVER;
        }
        return;
    }
    exchange.reply[exchange.count] |= (uint8_t)(high << exchange.bit);
    exchange.bit++;
    exchange.next_ns = exchange.begin_ns + (bits_ns(2 * exchange.bit + 3)) / 2;
}

static void send_bit(uint64_t now_ns) {
    if (exchange.bit < exchange.words.size * HAL_WIRE_BYTE_BITS) {
        drive(simulate_wire_bit(&exchange.words, exchange.bit++));
        exchange.next_ns = exchange.begin_ns + bits_ns(exchange.bit);
        return;
    }
    exchange.phase = PHASE_OVER;
    exchange.next_ns = HOST_CLOCK_NEVER;
    simulate_wire_sent(exchange.wire.tx_gpio, &exchange.words, now_ns);
    if (exchange.reply_size > 0) {
        let_go(exchange.wire.tx_gpio);
        await_byte(now_ns);
    }
}

// ---- Virtual time -------------------------------------------------------------------------------

uint64_t host_wire_next_ns(void) {
    return exchange.phase == PHASE_NONE ? HOST_CLOCK_NEVER : exchange.next_ns;
}

bool host_wire_run(uint64_t now_ns) {
    if (exchange.phase == PHASE_LISTEN) {
        begin_sending(now_ns);
    } else if (exchange.phase == PHASE_SEND) {
        send_bit(now_ns);
    } else if (exchange.phase == PHASE_RECEIVE) {
        take_bit(now_ns);
    }
    return exchange.phase == PHASE_OVER;
}

void host_wire_edges(uint64_t now_ns, uint32_t changed, uint32_t levels) {
    uint32_t mask = pins_mask(exchange.wire.rx_gpio);
    if ((changed & mask) == 0) {
        return;
    }
    if (exchange.phase == PHASE_LISTEN) {
        listen_from(now_ns, (levels & mask) != 0);
    } else if (exchange.phase == PHASE_AWAIT && (levels & mask) == 0) {
        start_byte(now_ns);
    }
}

// ---- The seam -----------------------------------------------------------------------------------

void hal_wire_open(const hal_wire_t *wire) {
    hal_pin_input(wire->rx_gpio, HAL_PULL_UP);
    hal_pin_input(wire->tx_gpio, HAL_PULL_UP);
    hal_pin_output(wire->tx_gpio, true);
}

void hal_wire_close(const hal_wire_t *wire) {
    if (exchange.wire.tx_gpio == wire->tx_gpio) {
        hal_wire_abort();
    }
    hal_pin_release(wire->tx_gpio);
    hal_pin_release(wire->rx_gpio);
}

void hal_wire_abort(void) {
    if (exchange.phase != PHASE_NONE) {
        exchange.phase = PHASE_NONE;
        let_go(exchange.wire.tx_gpio);
    }
}

// When what is left of the exchange may be over and when it has to be, from now on.
static void set_times(uint32_t idle_bits) {
    uint64_t now_ns = host_clock_now_ns();
    uint32_t ready_bits = hal_wire_ready_bits(exchange.words.size, exchange.reply_size);
    uint32_t give_up_bits = hal_wire_give_up_bits(exchange.words.size, exchange.reply_size);
    exchange.ready_ns = now_ns + bits_ns(idle_bits + ready_bits);
    exchange.give_up_ns = now_ns + bits_ns(idle_bits + give_up_bits);
}

void hal_wire_start(const hal_wire_t *wire, const uint8_t *send, size_t size, size_t reply_size) {
    uint64_t now_ns = host_clock_now_ns();
    memset(&exchange, 0, sizeof exchange);
    exchange.wire = *wire;
    exchange.words.size = size;
    exchange.words.baud = wire->baud;
    memcpy(exchange.words.bytes, send, size);
    exchange.reply_size = reply_size;
    exchange.held_ns = now_ns + bits_ns(HAL_WIRE_HELD_BITS);
    set_times(reply_size > 0 ? HAL_WIRE_IDLE_BITS : 0);
    if (reply_size > 0) {
        exchange.phase = PHASE_LISTEN;
        let_go(wire->tx_gpio);
        listen_from(now_ns, is_high(wire->rx_gpio));
    } else {
        begin_sending(now_ns);
    }
}

hal_wire_state_t hal_wire_poll(uint8_t *reply, uint64_t *again_us) {
    uint64_t now_ns = host_clock_now_ns();
    hal_wire_state_t state = HAL_WIRE_BUSY;
    if (exchange.phase == PHASE_NONE) {
        return HAL_WIRE_DONE;
    }
    if (exchange.phase == PHASE_OVER) {
        exchange.phase = PHASE_NONE;
        memcpy(reply, exchange.reply, exchange.reply_size);
        return exchange.garbled ? HAL_WIRE_GARBLED : HAL_WIRE_DONE;
    }
    if (exchange.phase == PHASE_LISTEN) {
        set_times(HAL_WIRE_IDLE_BITS);
        state = now_ns >= exchange.held_ns ? HAL_WIRE_HELD_LOW : state;
    } else if (now_ns >= exchange.give_up_ns) {
        state = HAL_WIRE_SILENT;
    }
    if (state != HAL_WIRE_BUSY) {
        hal_wire_abort();
    }
    uint64_t soon_ns = now_ns + bits_ns(HAL_WIRE_REPLY_EARLIEST_BITS);
    *again_us = (exchange.ready_ns > soon_ns ? exchange.ready_ns : soon_ns) / 1000 + 1;
    return state;
}
