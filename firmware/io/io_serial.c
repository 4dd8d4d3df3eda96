// Serial ports COM1 and COM2 of a program. Context: main loop.
#include "io_serial.h"

#include "hal/hal.h"
#include "io.h"
#include "io_pins.h"

static struct {
    uint8_t receive_gpio, send_gpio; // + 1; 0: none
    bool open;
} ports[HAL_SERIAL_PORTS];

static err_t check(unsigned port, unsigned gpio, bool sends) {
    err_t err = io_pins_check(gpio);
    bool fits = HAL_SERIAL_PORT(gpio) == port &&
                (sends ? HAL_SERIAL_SENDS(gpio) : HAL_SERIAL_RECEIVES(gpio));
    if (err == ERR_OK && !fits) {
        return err_raise(ERR_PIN_OTHER_USE, "%s cannot be COM%u %s", pins_name(gpio), port + 1,
                         sends ? "transmit" : "receive");
    }
    return err;
}

err_t io_serial_set_pins(unsigned port, unsigned receive_gpio, unsigned send_gpio) {
    if (ports[port].open) {
        return err_raise(ERR_COM_OPEN, "%u", port + 1);
    }
    err_t err = check(port, receive_gpio, false);
    err = err == ERR_OK ? check(port, send_gpio, true) : err;
    if (err != ERR_OK) {
        return err;
    }
    if (ports[port].receive_gpio != 0) { // other pins than before
        io_set_off(ports[port].receive_gpio - 1u);
    }
    io_pins_take(receive_gpio, IO_PINS_SERIAL);
    io_pins_take(send_gpio, IO_PINS_SERIAL);
    hal_pin_input(receive_gpio, HAL_PULL_UP);
    hal_pin_output(send_gpio, true); // the idle level, from now on
    ports[port].receive_gpio = (uint8_t)(receive_gpio + 1);
    ports[port].send_gpio = (uint8_t)(send_gpio + 1);
    return ERR_OK;
}

err_t io_serial_open(unsigned port, const hal_serial_t *settings) {
    if (ports[port].receive_gpio == 0) {
        return err_raise(ERR_COM_NO_PINS, "%u", port + 1);
    }
    if (ports[port].open) {
        return err_raise(ERR_COM_OPEN, "%u", port + 1);
    }
    hal_serial_open(port, ports[port].receive_gpio - 1u, ports[port].send_gpio - 1u, settings);
    ports[port].open = true;
    return ERR_OK;
}

void io_serial_close(unsigned port) {
    if (ports[port].open) {
        ports[port].open = false;
        hal_serial_close(port);
        hal_pin_input(ports[port].receive_gpio - 1u, HAL_PULL_UP);
        hal_pin_output(ports[port].send_gpio - 1u, true);
    }
}

bool io_serial_is_open(unsigned port) {
    return ports[port].open;
}

void io_serial_forget(unsigned gpio) {
    for (unsigned port = 0; port < HAL_SERIAL_PORTS; port++) {
        unsigned receive_gpio = ports[port].receive_gpio;
        unsigned send_gpio = ports[port].send_gpio;
        if (gpio + 1 != receive_gpio && gpio + 1 != send_gpio) {
            continue;
        }
        io_serial_close(port);
        ports[port].receive_gpio = ports[port].send_gpio =
            0; // so the other one finds nothing to forget
        io_set_off(gpio + 1 == receive_gpio ? send_gpio - 1 : receive_gpio - 1);
    }
}
