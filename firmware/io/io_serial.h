// Serial ports COM1 and COM2 of a program: pins, then a port on them. The second face of
// firmware/io. Context: main loop.
#ifndef IO_IO_SERIAL_H
#define IO_IO_SERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "hal/hal_serial.h"

// Gives a port (from 0) its pins. Errors: as those of io.h; a pin that cannot do it; the port is
// open.
err_t io_serial_set_pins(unsigned port, unsigned receive_gpio, unsigned send_gpio);

// Errors: no pins (SETPIN), already open.
err_t io_serial_open(unsigned port, const hal_serial_t *settings);

// No effect on a closed port.
void io_serial_close(unsigned port);

// SETPIN or RUN may have taken the pins from an open port.
bool io_serial_is_open(unsigned port);

// A pin gets another use: its port is closed and has no pins any more. Inside firmware/io only.
void io_serial_forget(unsigned gpio);

#endif
