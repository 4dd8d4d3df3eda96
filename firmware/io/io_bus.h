// Buses of a program: pins, then a bus on them. The third face of firmware/io. Context: main loop.
#ifndef IO_IO_BUS_H
#define IO_IO_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"
#include "hal/hal_i2c.h"
#include "hal/hal_spi.h"

// The first one of a kind is the controller's port 0.
typedef enum { IO_BUS_I2C, IO_BUS_I2C2, IO_BUS_SPI, IO_BUS_SPI2, IO_BUSES } io_bus_t;

#define IO_BUS_PINS_MAX 3

// Gives a bus its pins, in the order of SETPIN: I2C has data and clock, SPI receive, transmit
// and clock.
// Errors: as those of io.h; a pin that cannot do it; the bus is open.
err_t io_bus_set_pins(io_bus_t bus, const unsigned gpios[]);

// Errors: no pins (SETPIN), already open.
err_t io_bus_open_i2c(io_bus_t bus, uint32_t khz);
err_t io_bus_open_spi(io_bus_t bus, const hal_spi_t *settings);

// Error: it is not open. SETPIN or RUN may have taken its pins.
err_t io_bus_check_open(io_bus_t bus);

// Error: it is not open.
err_t io_bus_close(io_bus_t bus);

// A pin gets another use: its bus is closed and has no pins any more. Inside firmware/io only.
void io_bus_forget(unsigned gpio);

#endif
