// The wires that are open, and who owns their pins. Context: main loop.
#ifndef TMC22XX_WIRES_H
#define TMC22XX_WIRES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"
#include "hal/hal_wire.h"

#define WIRES 8u // one for each driver
#define WIRES_NONE 0xFFu

// The wire that sends at this pin; WIRES_NONE: none.
unsigned wires_find(uint8_t tx_gpio);

// Opens a wire, or wires one anew that is there. Errors: pins, baud rate, too many; nothing has
// changed then.
err_t wires_set(uint8_t tx_gpio, uint8_t rx_gpio, uint32_t baud);

// Gives the pins back.
void wires_close(unsigned wire);

// NULL: there is none with this index, 0 to WIRES - 1. Valid until the wire closes.
const hal_wire_t *wires_get(unsigned wire);

#endif
