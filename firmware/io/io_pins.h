// What each pin is used for, and whose it is. Inside firmware/io only. Context: main loop.
#ifndef IO_IO_PINS_H
#define IO_IO_PINS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

typedef enum {
    IO_PINS_OFF,
    IO_PINS_INPUT,
    IO_PINS_OUTPUT,
    IO_PINS_VOLTAGE,
    IO_PINS_RAW,
    IO_PINS_FREQUENCY,
    IO_PINS_PERIOD,
    IO_PINS_COUNTER,
    IO_PINS_INTERRUPT,
    IO_PINS_PWM,
    IO_PINS_SERIAL,
    IO_PINS_I2C,
    IO_PINS_SPI,
    IO_PINS_USES
} io_pins_use_t;

io_pins_use_t io_pins_use(unsigned gpio);

// Could the program have this pin? Errors: no such pin, or another part's.
err_t io_pins_check(unsigned gpio);

// Ends the present use and claims the pin for a new one. The pin has been checked; making it what
// its new use needs is the caller's next step.
void io_pins_take(unsigned gpio, io_pins_use_t use);

#endif
