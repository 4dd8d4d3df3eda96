// I2C and SPI buses of a program. Context: main loop.
#include "io_bus.h"

#include <string.h>

#include "hal/hal.h"
#include "io.h"
#include "io_pins.h"

// A pin belongs to a port and has a role there by its number: blocks of `block` pins go to the
// ports in turn, and the remainder of `roles` is the role.
typedef struct {
    const char *name;
    uint8_t use; // io_pins_use_t
    uint8_t port;
    uint8_t block;
    uint8_t roles;
    uint8_t count;
    struct {
        const char *name;
        uint8_t role;
        bool is_output;
    } pins[IO_BUS_PINS_MAX];
} row_t;

#define I2C_ROLES                                                                                  \
    .block = 2, .roles = 2, .count = 2, .pins = {{"data", 0, false}, {"clock", 1, false}}
#define SPI_ROLES                                                                                  \
    .block = 8, .roles = 4, .count = 3,                                                            \
    .pins = {{"receive", 0, false}, {"transmit", 3, true}, {"clock", 2, true}}

static const row_t rows[IO_BUSES] = {
    [IO_BUS_I2C] = {"I2C", IO_PINS_I2C, 0, I2C_ROLES},
    [IO_BUS_I2C2] = {"I2C2", IO_PINS_I2C, 1, I2C_ROLES},
    [IO_BUS_SPI] = {"SPI", IO_PINS_SPI, 0, SPI_ROLES},
    [IO_BUS_SPI2] = {"SPI2", IO_PINS_SPI, 1, SPI_ROLES},
};

static struct {
    uint8_t gpios[IO_BUS_PINS_MAX]; // + 1; the first is 0: no pins
    bool open;
} buses[IO_BUSES];

static bool is_i2c(io_bus_t bus) {
    return rows[bus].use == IO_PINS_I2C;
}

static unsigned gpio_of(io_bus_t bus, unsigned index) {
    return buses[bus].gpios[index] - 1u;
}

// ---- Pins ---------------------------------------------------------------------------------------

static err_t check_pin(const row_t *row, unsigned index, unsigned gpio) {
    err_t err = io_pins_check(gpio);
    bool fits = gpio / row->block % 2 == row->port && gpio % row->roles == row->pins[index].role;
    if (err == ERR_OK && !fits) {
        return err_raise(ERR_PIN_OTHER_USE, "%s cannot be %s %s", pins_name(gpio), row->name,
                         row->pins[index].name);
    }
    return err;
}

// What the pins are while the bus is closed.
static void rest(io_bus_t bus) {
    for (unsigned i = 0; i < rows[bus].count; i++) {
        if (rows[bus].pins[i].is_output) {
            hal_pin_output(gpio_of(bus, i), false);
        } else {
            hal_pin_input(gpio_of(bus, i), is_i2c(bus) ? HAL_PULL_UP : HAL_PULL_NONE);
        }
    }
}

err_t io_bus_set_pins(io_bus_t bus, const unsigned gpios[]) {
    const row_t *row = &rows[bus];
    if (buses[bus].open) {
        return err_raise(ERR_BUS_OPEN, "%s", row->name);
    }
    for (unsigned i = 0; i < row->count; i++) {
        err_t err = check_pin(row, i, gpios[i]);
        if (err != ERR_OK) {
            return err;
        }
    }
    if (buses[bus].gpios[0] != 0) { // other pins than before
        io_set_off(gpio_of(bus, 0));
    }
    for (unsigned i = 0; i < row->count; i++) {
        io_pins_take(gpios[i], (io_pins_use_t)row->use);
        buses[bus].gpios[i] = (uint8_t)(gpios[i] + 1);
    }
    rest(bus);
    return ERR_OK;
}

static bool has_pin(io_bus_t bus, unsigned gpio) {
    return memchr(buses[bus].gpios, (int)gpio + 1, sizeof buses[bus].gpios) != NULL;
}

void io_bus_forget(unsigned gpio) {
    for (io_bus_t bus = 0; bus < IO_BUSES; bus++) {
        if (!has_pin(bus, gpio)) {
            continue;
        }
        if (buses[bus].open) {
            io_bus_close(bus);
        }
        uint8_t gpios[IO_BUS_PINS_MAX];
        memcpy(gpios, buses[bus].gpios, sizeof gpios);
        memset(buses[bus].gpios, 0, sizeof gpios); // so the others find nothing to forget
        for (unsigned i = 0; i < rows[bus].count; i++) {
            if (gpios[i] != gpio + 1) {
                io_set_off(gpios[i] - 1u);
            }
        }
    }
}

// ---- Open and closed ----------------------------------------------------------------------------

static err_t check_closed(io_bus_t bus) {
    if (buses[bus].gpios[0] == 0) {
        return err_raise(ERR_BUS_NO_PINS, "%s", rows[bus].name);
    }
    return buses[bus].open ? err_raise(ERR_BUS_OPEN, "%s", rows[bus].name) : ERR_OK;
}

err_t io_bus_open_i2c(io_bus_t bus, uint32_t khz) {
    err_t err = check_closed(bus);
    if (err == ERR_OK) {
        hal_i2c_open(rows[bus].port, gpio_of(bus, 0), gpio_of(bus, 1), khz);
        buses[bus].open = true;
    }
    return err;
}

err_t io_bus_open_spi(io_bus_t bus, const hal_spi_t *settings) {
    err_t err = check_closed(bus);
    if (err == ERR_OK) {
        hal_spi_open(rows[bus].port, gpio_of(bus, 0), gpio_of(bus, 1), gpio_of(bus, 2), settings);
        buses[bus].open = true;
    }
    return err;
}

err_t io_bus_check_open(io_bus_t bus) {
    return buses[bus].open ? ERR_OK : err_raise(ERR_BUS_CLOSED, "%s", rows[bus].name);
}

err_t io_bus_close(io_bus_t bus) {
    err_t err = io_bus_check_open(bus);
    if (err == ERR_OK) {
        buses[bus].open = false;
        (is_i2c(bus) ? hal_i2c_close : hal_spi_close)(rows[bus].port);
        rest(bus);
    }
    return err;
}
