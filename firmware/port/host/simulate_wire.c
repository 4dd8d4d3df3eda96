// Listeners at the simulated serial wires. Each has its own level on the line; the pad sees the
// lowest of them, and where the firmware hears by a pin of its own, what it sends itself. Context:
// any.
#include "simulate_wire.h"

#include "hal/hal_wire.h"
#include "host_clock.h"
#include "host_pads.h"

typedef struct {
    simulate_wire_listener_t is;
    simulate_wire_words_t words; // being said, or to be said
    unsigned bit;                // of them is next
    uint64_t next_ns;            // of its edge
    bool low;                    // its level
    bool held;                   // it pulls the line down all the time
} listener_t;

static struct {
    listener_t list[SIMULATE_WIRE_LISTENERS_MAX];
    unsigned count;
    uint32_t sent_low; // sending pins that the firmware has pulled low
} wire;

// Shows at the pad what all that is connected to it comes to.
static void show(unsigned rx_gpio) {
    bool low = false;
    for (unsigned i = 0; i < wire.count; i++) {
        const listener_t *listener = &wire.list[i];
        if (listener->is.rx_gpio == rx_gpio) {
            bool echo = listener->is.tx_gpio != rx_gpio &&
                        (wire.sent_low >> listener->is.tx_gpio & 1u) != 0;
            low |= listener->low || listener->held || echo;
        }
    }
    if (low) {
        host_pads_drive(rx_gpio, false);
    } else {
        host_pads_let_go(rx_gpio);
    }
}

unsigned simulate_wire_attach(const simulate_wire_listener_t *listener) {
    if (wire.count == SIMULATE_WIRE_LISTENERS_MAX) {
        return SIMULATE_WIRE_LISTENERS_MAX;
    }
    wire.list[wire.count] = (listener_t){.is = *listener, .next_ns = HOST_CLOCK_NEVER};
    return wire.count++;
}

// ---- Speaking -----------------------------------------------------------------------------------

static uint64_t bit_ns(const simulate_wire_words_t *words, unsigned bit) {
    return words->start_ns + (uint64_t)(bit * 1e9 / words->baud + 0.5);
}

bool simulate_wire_bit(const simulate_wire_words_t *words, unsigned bit) {
    unsigned byte = bit / HAL_WIRE_BYTE_BITS;
    unsigned place = bit % HAL_WIRE_BYTE_BITS;
    if (byte >= words->size) {
        return true;
    }
    if (place == HAL_WIRE_BYTE_BITS - 1) {
        return (words->no_stop_bytes >> byte & 1) == 0;
    }
    return place > 0 && (words->bytes[byte] >> (place - 1) & 1) != 0;
}

void simulate_wire_say(unsigned listener, const simulate_wire_words_t *words) {
    listener_t *speaker = &wire.list[listener];
    uint64_t now_ns = host_clock_now_ns();
    speaker->words = *words;
    speaker->words.start_ns = words->start_ns < now_ns ? now_ns : words->start_ns;
    speaker->bit = 0;
    speaker->next_ns = words->size > 0 ? speaker->words.start_ns : HOST_CLOCK_NEVER;
    speaker->low = false;
    show(speaker->is.rx_gpio);
}

// The bit behind the last one lets go of the line.
static void say_bit(listener_t *listener) {
    const simulate_wire_words_t *words = &listener->words;
    listener->low = !simulate_wire_bit(words, listener->bit++);
    listener->next_ns = listener->bit <= words->size * HAL_WIRE_BYTE_BITS
                            ? bit_ns(words, listener->bit)
                            : HOST_CLOCK_NEVER;
    show(listener->is.rx_gpio);
}

void simulate_wire_hold(unsigned listener, bool low) {
    wire.list[listener].held = low;
    show(wire.list[listener].is.rx_gpio);
}

uint64_t simulate_wire_next_ns(void) {
    uint64_t next_ns = HOST_CLOCK_NEVER;
    for (unsigned i = 0; i < wire.count; i++) {
        next_ns = wire.list[i].next_ns < next_ns ? wire.list[i].next_ns : next_ns;
    }
    return next_ns;
}

void simulate_wire_run(uint64_t now_ns) {
    for (unsigned i = 0; i < wire.count; i++) {
        if (wire.list[i].next_ns <= now_ns) {
            say_bit(&wire.list[i]);
        }
    }
}

// ---- Listening ----------------------------------------------------------------------------------

void simulate_wire_sent(unsigned tx_gpio, const simulate_wire_words_t *words, uint64_t end_ns) {
    for (unsigned i = 0; i < wire.count; i++) {
        if (wire.list[i].is.tx_gpio == tx_gpio && wire.list[i].is.frame != NULL) {
            wire.list[i].is.frame(wire.list[i].is.state, words, end_ns);
        }
    }
}

void simulate_wire_level(unsigned tx_gpio, bool level) {
    uint32_t mask = (uint32_t)1 << tx_gpio;
    wire.sent_low = level ? wire.sent_low & ~mask : wire.sent_low | mask;
    for (unsigned i = 0; i < wire.count; i++) {
        if (wire.list[i].is.tx_gpio == tx_gpio && wire.list[i].is.rx_gpio != tx_gpio) {
            show(wire.list[i].is.rx_gpio);
        }
    }
}
