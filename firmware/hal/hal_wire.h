// A wire that carries serial bytes both ways: driver chips of motors take registers and give them
// back over it. 8 data bits, no parity, the lowest first, idle high. One exchange at a time, on one
// of several open wires; it goes on without the processor, and nothing is masked meanwhile. The
// rules of hal.h apply. Context: main loop.
//
// Where nobody is expected to answer, the line is driven high between two exchanges. When a reply
// is expected it is let go of, with a pull-up, and stays so until the next exchange: a reply that
// comes late or has more bytes than it should meets nobody.
#ifndef HAL_HAL_WIRE_H
#define HAL_HAL_WIRE_H

#include <stddef.h>
#include <stdint.h>

#define HAL_WIRE_BAUD_MIN 9600u
#define HAL_WIRE_BAUD_MAX 500000u
#define HAL_WIRE_SEND_MAX 8u // bytes
#define HAL_WIRE_REPLY_MAX 8u

// How long an exchange may last, in bit times: the line has to be idle for a while before something
// is sent that is to be answered (else it counts as held), the reply may begin so long behind the
// request, and its bytes follow each other without a pause. A driver that has seen something wrong
// on the line listens again when it has been idle for 12 bit times.
#define HAL_WIRE_IDLE_BITS 13u
#define HAL_WIRE_HELD_BITS 110u
#define HAL_WIRE_REPLY_EARLIEST_BITS 8u
#define HAL_WIRE_REPLY_LATEST_BITS 128u
#define HAL_WIRE_TAKE_BITS 1u  // driven high before the first start bit
#define HAL_WIRE_BYTE_BITS 10u // with start and stop bit

// For the ports: so many bit times after the line was taken an exchange may be over, and has to be.
static inline uint32_t hal_wire_ready_bits(size_t send_size, size_t reply_size) {
    uint32_t reply_bits = (uint32_t)reply_size * HAL_WIRE_BYTE_BITS;
    return HAL_WIRE_TAKE_BITS + (uint32_t)send_size * HAL_WIRE_BYTE_BITS + reply_bits +
           (reply_size > 0 ? HAL_WIRE_REPLY_EARLIEST_BITS : 0);
}

static inline uint32_t hal_wire_give_up_bits(size_t send_size, size_t reply_size) {
    return HAL_WIRE_TAKE_BITS + (uint32_t)(send_size + reply_size + 1) * HAL_WIRE_BYTE_BITS +
           HAL_WIRE_REPLY_LATEST_BITS;
}

typedef struct {
    uint8_t tx_gpio;
    uint8_t rx_gpio; // the same pin: it sends and listens
    uint32_t baud;
} hal_wire_t;

typedef enum {
    HAL_WIRE_BUSY,
    HAL_WIRE_DONE,
    HAL_WIRE_SILENT,  // no reply, or not all of it, in time
    HAL_WIRE_GARBLED, // a byte of the reply has no stop bit
    HAL_WIRE_HELD_LOW // the line is low, or never idle: nothing was sent
} hal_wire_state_t;

// Makes the pins ready; the line is high from now on, without a glitch. No effect on an exchange
// that is under way on another wire.
void hal_wire_open(const hal_wire_t *wire);

// The pins are as after reset. An exchange under way on this wire is given up.
void hal_wire_close(const hal_wire_t *wire);

// Sends 1 to HAL_WIRE_SEND_MAX bytes and then takes `reply_size` bytes from the line; 0: nothing is
// expected, and they are sent whatever the line looks like. The wire must be open and no exchange
// under way; its baud rate may differ from when it was opened. Nothing is kept of the arguments.
void hal_wire_start(const hal_wire_t *wire, const uint8_t *send, size_t size, size_t reply_size);

// How the exchange goes on. Once it is not busy it is over; when it is done the bytes are in
// `reply`. Busy: `again_us` is when it is worth asking again.
hal_wire_state_t hal_wire_poll(uint8_t *reply, uint64_t *again_us);

// Gives an exchange up at once, and lets go of the line. Without effect if there is none.
void hal_wire_abort(void);

#endif
