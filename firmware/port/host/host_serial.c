// Serial ports that wear a loopback plug: what a program sends comes back to it, each byte when its
// stop bit is over. Context: main.
#include "host_serial.h"

#include "base/base.h"
#include "hal/hal.h"
#include "hal/hal_serial.h"
#include "host_clock.h"

// Bytes on their way and received ones; the wire takes as many as both buffers of a board.
#define WIRE_SIZE (HAL_SERIAL_RECEIVE_SIZE + HAL_SERIAL_SEND_SIZE)

static struct {
    ring_t wire;
    uint8_t bytes[WIRE_SIZE];
    uint64_t arrives_ns[WIRE_SIZE];
    uint64_t last_ns;    // when the last byte has been sent
    uint64_t byte_ns;    // 0: the port is closed
    uint64_t noticed_ns; // what arrived up to here has been told
    size_t receive_size;
} ports[HAL_SERIAL_PORTS];

void hal_serial_open(unsigned port, unsigned receive_gpio, unsigned send_gpio,
                     const hal_serial_t *settings) {
    (void)receive_gpio;
    (void)send_gpio;
    unsigned bits = 1u + settings->data_bits + settings->stop_bits;
    bits += settings->parity != HAL_PARITY_NONE;
    ring_reset(&ports[port].wire, WIRE_SIZE);
    ports[port].byte_ns = bits * UINT64_C(1000000000) / settings->baud;
    ports[port].receive_size = settings->receive_size;
}

void hal_serial_close(unsigned port) {
    ports[port].byte_ns = 0;
}

// Bytes of the wire that have arrived by now, lost ones included.
static size_t arrived(unsigned port) {
    size_t used = ring_used(&ports[port].wire);
    size_t slot = ports[port].wire.take_slot;
    size_t count = 0;
    while (count < used && ports[port].arrives_ns[slot] <= host_clock_now_ns()) {
        slot = slot + 1 < WIRE_SIZE ? slot + 1 : 0;
        count++;
    }
    return count;
}

size_t hal_serial_waiting(unsigned port) {
    return ports[port].byte_ns != 0 ? arrived(port) : 0;
}

size_t hal_serial_read(unsigned port, uint8_t *bytes, size_t size) {
    size_t waiting = hal_serial_waiting(port);
    size_t count = 0;
    for (; count < size && count < waiting; count++) {
        bytes[count] = ports[port].bytes[ports[port].wire.take_slot];
        ring_take(&ports[port].wire);
    }
    return count;
}

size_t hal_serial_room(unsigned port) {
    if (ports[port].byte_ns == 0) {
        return 0;
    }
    size_t unsent = ring_used(&ports[port].wire) - arrived(port);
    return unsent < HAL_SERIAL_SEND_SIZE ? HAL_SERIAL_SEND_SIZE - unsent : 0;
}

bool hal_serial_is_sent(unsigned port) {
    return ports[port].byte_ns == 0 || ports[port].last_ns <= host_clock_now_ns();
}

size_t hal_serial_write(unsigned port, const uint8_t *bytes, size_t size) {
    size_t count = 0;
    for (; count < size && hal_serial_room(port) > 0; count++) {
        uint64_t now_ns = host_clock_now_ns();
        uint64_t begin_ns = ports[port].last_ns > now_ns ? ports[port].last_ns : now_ns;
        ports[port].last_ns = begin_ns + ports[port].byte_ns;
        size_t unread = ring_used(&ports[port].wire);
        if (unread < WIRE_SIZE && unread < ports[port].receive_size + HAL_SERIAL_SEND_SIZE) {
            ports[port].bytes[ports[port].wire.put_slot] = bytes[count];
            ports[port].arrives_ns[ports[port].wire.put_slot] = ports[port].last_ns;
            ring_put(&ports[port].wire);
        }
    }
    return count;
}

// ---- News ---------------------------------------------------------------------------------------

uint64_t host_serial_next_ns(void) {
    uint64_t next_ns = HOST_CLOCK_NEVER;
    for (unsigned port = 0; port < HAL_SERIAL_PORTS; port++) {
        size_t slot = ports[port].wire.take_slot;
        for (size_t left = ring_used(&ports[port].wire); left > 0 && ports[port].byte_ns != 0;
             left--) {
            uint64_t arrives_ns = ports[port].arrives_ns[slot];
            if (arrives_ns > ports[port].noticed_ns) {
                next_ns = arrives_ns < next_ns ? arrives_ns : next_ns;
                break;
            }
            slot = slot + 1 < WIRE_SIZE ? slot + 1 : 0;
        }
    }
    return next_ns;
}

void host_serial_notice(uint64_t now_ns) {
    for (unsigned port = 0; port < HAL_SERIAL_PORTS; port++) {
        ports[port].noticed_ns = now_ns;
    }
}
