// Inputs, outputs and their levels, one by one and several at once. Context: main loop.
#include "io.h"

#include "io_analog.h"
#include "io_count.h"
#include "io_pins.h"
#include "io_pulse.h"

err_t io_set_input(unsigned gpio, hal_pull_t pull) {
    err_t err = io_pins_check(gpio);
    if (err == ERR_OK) {
        io_pins_take(gpio, IO_PINS_INPUT);
        hal_pin_input(gpio, pull);
    }
    return err;
}

err_t io_set_output(unsigned gpio) {
    err_t err = io_pins_check(gpio);
    if (err == ERR_OK && io_pins_use(gpio) != IO_PINS_OUTPUT) { // an output keeps its level
        io_pins_take(gpio, IO_PINS_OUTPUT);
        hal_pin_output(gpio, false);
    }
    return err;
}

static bool level_of(unsigned gpio) {
    return (hal_pins_read() & pins_mask(gpio)) != 0;
}

static err_t check_readable(unsigned gpio) {
    if (!pins_is_user(gpio)) {
        return err_raise(ERR_PIN_INVALID, "GP%u", gpio);
    }
    if (io_pins_use(gpio) == IO_PINS_OFF && pins_owner(gpio) == NULL) {
        return err_raise(ERR_PIN_NOT_SET, "%s", pins_name(gpio));
    }
    return ERR_OK;
}

err_t io_read(unsigned gpio, io_value_t *value) {
    err_t err = check_readable(gpio);
    if (err != ERR_OK) {
        return err;
    }
    *value = (io_value_t){.is_whole = true};
    switch (io_pins_use(gpio)) {
    case IO_PINS_VOLTAGE:
        *value = (io_value_t){.number = io_analog_volts(gpio)};
        break;
    case IO_PINS_RAW:
        value->whole = io_analog_raw(gpio);
        break;
    case IO_PINS_FREQUENCY:
        *value = (io_value_t){.number = io_count_hz(gpio)};
        break;
    case IO_PINS_PERIOD:
        *value = (io_value_t){.number = io_count_period_ms(gpio)};
        break;
    case IO_PINS_COUNTER:
        value->whole = io_count_edges(gpio);
        break;
    default:
        value->whole = level_of(gpio);
        break;
    }
    return ERR_OK;
}

static err_t check_output(unsigned gpio) {
    if (io_pins_use(gpio) == IO_PINS_OUTPUT) {
        return ERR_OK;
    }
    err_t err = io_pins_check(gpio);
    return err != ERR_OK ? err : err_raise(ERR_PIN_NOT_OUTPUT, "%s", pins_name(gpio));
}

err_t io_write(unsigned gpio, int64_t value) {
    if (io_pins_use(gpio) == IO_PINS_COUNTER) {
        io_count_set(gpio, value);
        return ERR_OK;
    }
    if (gpio >= PINS_COUNT) {
        return err_raise(ERR_PIN_INVALID, "GP%u", gpio);
    }
    return io_write_port(pins_mask(gpio), value != 0 ? UINT32_MAX : 0);
}

err_t io_read_port(uint32_t pins, uint32_t *levels) {
    for (uint32_t rest = pins; rest != 0; rest &= rest - 1) {
        err_t err = check_readable((unsigned)__builtin_ctz(rest));
        if (err != ERR_OK) {
            return err;
        }
    }
    *levels = hal_pins_read() & pins;
    return ERR_OK;
}

err_t io_write_port(uint32_t pins, uint32_t levels) {
    for (uint32_t rest = pins; rest != 0; rest &= rest - 1) {
        err_t err = check_output((unsigned)__builtin_ctz(rest));
        if (err != ERR_OK) {
            return err;
        }
    }
    for (uint32_t rest = pins; rest != 0; rest &= rest - 1) {
        io_pulse_forget((unsigned)__builtin_ctz(rest));
    }
    hal_pins_set(pins & levels);
    hal_pins_clear(pins & ~levels);
    return ERR_OK;
}
