// One datagram on a wire and, if it asks for something, its answer. Keeps the pause between two
// datagrams, and lets a wire be quiet after an answer that did not come as it should, so that one
// that comes late meets nobody. Context: main loop.
#ifndef TMC22XX_EXCHANGE_H
#define TMC22XX_EXCHANGE_H

#include <stdint.h>

#include "hal/hal_wire.h"

#define EXCHANGE_PAUSE_US 200u // between two datagrams

// How late an answer may begin and still be over before the next datagram, besides the bit times.
#define EXCHANGE_LATE_US 15000u

typedef enum {
    EXCHANGE_BUSY,
    EXCHANGE_DONE,
    EXCHANGE_SILENT,
    EXCHANGE_GARBLED, // something came that is not the answer to this request
    EXCHANGE_HELD_LOW // nothing was sent
} exchange_state_t;

// Begins one; the wire must stay open, and none may be under way.
void exchange_write(const hal_wire_t *wire, uint8_t address, uint8_t reg, uint32_t value);
void exchange_read(const hal_wire_t *wire, uint8_t address, uint8_t reg);

// Takes it on. Once it is not busy it is over. `value` of a register that was read.
exchange_state_t exchange_poll(uint32_t *value);

// When it is worth calling exchange_poll() again.
uint64_t exchange_wake_us(void);

// Gives it up: its wire closes.
void exchange_abort(void);

#endif
