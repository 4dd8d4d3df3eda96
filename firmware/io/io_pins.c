// What each pin is used for, and whose it is. Context: main loop.
#include "io_pins.h"

#include <string.h>

#include "hal/hal.h"
#include "io.h"
#include "io_bus.h"
#include "io_count.h"
#include "io_pulse.h"
#include "io_serial.h"
#include "io_slices.h"
#include "io_watch.h"

static uint8_t uses[PINS_COUNT]; // io_pins_use_t

// Whom a refused user of the pin is told about.
static const char *const owners[IO_PINS_USES] = {
    [IO_PINS_INPUT] = "SETPIN DIN",     [IO_PINS_OUTPUT] = "SETPIN DOUT",
    [IO_PINS_VOLTAGE] = "SETPIN AIN",   [IO_PINS_RAW] = "SETPIN ARAW",
    [IO_PINS_FREQUENCY] = "SETPIN FIN", [IO_PINS_PERIOD] = "SETPIN PIN",
    [IO_PINS_COUNTER] = "SETPIN CIN",   [IO_PINS_INTERRUPT] = "SETPIN INT",
    [IO_PINS_PWM] = "SETPIN PWM",       [IO_PINS_SERIAL] = "SETPIN COM",
    [IO_PINS_I2C] = "SETPIN I2C",       [IO_PINS_SPI] = "SETPIN SPI",
};

io_pins_use_t io_pins_use(unsigned gpio) {
    return gpio < PINS_COUNT ? (io_pins_use_t)uses[gpio] : IO_PINS_OFF;
}

err_t io_pins_check(unsigned gpio) {
    if (io_pins_use(gpio) != IO_PINS_OFF) {
        return ERR_OK;
    }
    err_t err = pins_claim(gpio, "SETPIN");
    if (err == ERR_OK) {
        pins_disclaim(gpio);
    }
    return err;
}

static void end_use(unsigned gpio) {
    switch (io_pins_use(gpio)) {
    case IO_PINS_OUTPUT:
        io_pulse_forget(gpio);
        break;
    case IO_PINS_FREQUENCY:
    case IO_PINS_PERIOD:
    case IO_PINS_COUNTER:
        io_count_stop(gpio);
        break;
    case IO_PINS_INTERRUPT:
        io_watch_stop(gpio);
        break;
    case IO_PINS_PWM:
        io_slices_remove(gpio);
        break;
    case IO_PINS_SERIAL:
        io_serial_forget(gpio);
        break;
    case IO_PINS_I2C:
    case IO_PINS_SPI:
        io_bus_forget(gpio);
        break;
    default:
        break;
    }
}

void io_pins_take(unsigned gpio, io_pins_use_t use) {
    end_use(gpio);
    pins_disclaim(gpio);
    pins_claim(gpio, owners[use]);
    uses[gpio] = (uint8_t)use;
}

err_t io_set_off(unsigned gpio) {
    if (io_pins_use(gpio) == IO_PINS_OFF) {
        return io_pins_check(gpio);
    }
    end_use(gpio);
    hal_pin_release(gpio);
    pins_disclaim(gpio);
    uses[gpio] = IO_PINS_OFF;
    return ERR_OK;
}

void io_reset(void) {
    for (unsigned gpio = 0; gpio < PINS_COUNT; gpio++) {
        if (uses[gpio] != IO_PINS_OFF) {
            io_set_off(gpio);
        }
    }
    io_set_reference(IO_REFERENCE_VOLTS);
}
