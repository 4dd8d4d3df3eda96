// What hangs at the simulated serial wires (hal/hal_wire.h): listeners that are told about each
// frame the firmware sends and may answer, bit by bit at the pads, whenever they like. Context: any
// (called when virtual time reaches the end of the frame).
#ifndef SIMULATE_WIRE_H
#define SIMULATE_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SIMULATE_WIRE_LISTENERS_MAX 16u
#define SIMULATE_WIRE_BYTES_MAX 16u

// Bytes on the line, one behind the other.
typedef struct {
    uint8_t bytes[SIMULATE_WIRE_BYTES_MAX];
    size_t size;            // 0: nothing is said
    uint32_t no_stop_bytes; // bit n: byte n has a low stop bit
    uint64_t start_ns;      // the edge of the first start bit
    double baud;            // the sender's own idea of it
} simulate_wire_words_t;

// `words`: what the firmware sent, complete, with the time of its first edge and its baud rate;
// `end_ns`: the end of the last stop bit, which is now.
typedef void (*simulate_wire_frame_t)(void *state, const simulate_wire_words_t *words,
                                      uint64_t end_ns);

// Fill in, then simulate_wire_attach().
typedef struct {
    unsigned tx_gpio; // where the firmware sends
    unsigned rx_gpio; // where it hears the answers; the same pin, or one that sees what is sent too
    simulate_wire_frame_t frame; // NULL: it only speaks
    void *state;
} simulate_wire_listener_t;

// The level of the line at a bit of the words, start and stop bits included; high behind them.
bool simulate_wire_bit(const simulate_wire_words_t *words, unsigned bit);

// Listens from now on. Returns its number, by which it speaks; SIMULATE_WIRE_LISTENERS_MAX: there
// is no room.
unsigned simulate_wire_attach(const simulate_wire_listener_t *listener);

// Says the words when their time has come, at the earliest now; what the listener was saying or was
// to say is forgotten. The lowest of all levels on a line is seen.
void simulate_wire_say(unsigned listener, const simulate_wire_words_t *words);

// Pulls the line down for good, as a chip without power does, or lets go of it.
void simulate_wire_hold(unsigned listener, bool low);

// Time of the next edge that a listener makes, UINT64_MAX: none; and making those due at `now_ns`.
// For host_clock.c.
uint64_t simulate_wire_next_ns(void);
void simulate_wire_run(uint64_t now_ns);

// The firmware has sent a frame, or its level on a sending pin has changed. For host_wire.c.
void simulate_wire_sent(unsigned tx_gpio, const simulate_wire_words_t *words, uint64_t end_ns);
void simulate_wire_level(unsigned tx_gpio, bool level);

#endif
