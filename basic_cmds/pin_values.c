// PIN, PORT, PULSE, PWM and SERVO: what pins are and do. Context: main loop.
#include "basic_cmds/pin_values.h"

#include "io/io.h"

#define OPTIONAL BASIC_ARG_OPTIONAL
#define DEFAULTS (BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT)

#define PIN_ARG {"pin", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER, .help = "the pin"}
#define START_ARG(more)                                                                            \
    {"start", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER | (more),                                      \
     .help = "lowest pin of the group; the first group has the lowest bits"}
#define BITS_ARG                                                                                   \
    {"bits", BASIC_ARG_INTEGER, .min = 1, .max = PINS_COUNT,                                       \
     .help = "how many pins, by their GPIO numbers"}
#define SLICE_ARG                                                                                  \
    {"slice", BASIC_ARG_INTEGER, .min = 0, .max = HAL_PWM_SLICES - 1, .help = "the PWM slice"}
#define DUTY_ARG(name, output)                                                                     \
    {name,                                                                                         \
     BASIC_ARG_NUMBER,                                                                             \
     OPTIONAL,                                                                                     \
     .min = -100,                                                                                  \
     .max = 100,                                                                                   \
     .unit = "%",                                                                                  \
     .help = "how long output " output " is high; negative: low"}
#define POSITION_ARG(name, output)                                                                 \
    {name,                                                                                         \
     BASIC_ARG_NUMBER,                                                                             \
     OPTIONAL,                                                                                     \
     .min = IO_SERVO_MIN,                                                                          \
     .max = IO_SERVO_MAX,                                                                          \
     .unit = "%",                                                                                  \
     .help = "pulse of output " output ": 0 is 1 ms, 100 is 2 ms"}
#define SYNC_ARG(name)                                                                             \
    {name,                                                                                         \
     BASIC_ARG_NUMBER,                                                                             \
     OPTIONAL,                                                                                     \
     .min = -1,                                                                                    \
     .max = 100,                                                                                   \
     .unit = "%",                                                                                  \
     .help = "where in its period this slice starts; -1: not at all"}

const basic_arg_spec_t pin_values_read_args[] = {PIN_ARG};
const basic_arg_spec_t pin_values_write_args[] = {
    {"value", BASIC_ARG_INTEGER, .help = "0 is low, all else high; of CIN the count"},
    PIN_ARG,
};
const basic_arg_spec_t pin_values_read_port_args[] = {
    START_ARG(0),
    BITS_ARG,
    START_ARG(BASIC_ARG_REPEAT),
    BITS_ARG,
};
const basic_arg_spec_t pin_values_write_port_args[] = {
    {"value", BASIC_ARG_INTEGER, .help = "a bit for each pin"},
    START_ARG(0),
    BITS_ARG,
    START_ARG(BASIC_ARG_REPEAT),
    BITS_ARG,
};
const basic_arg_spec_t pin_values_pulse_args[] = {
    PIN_ARG,
    {"width", BASIC_ARG_NUMBER, .min = 0, .max = IO_PULSE_MAX_MS, .unit = "ms",
     .help = "how long; from 3 ms on the program goes on meanwhile, 0 ends a pulse"},
};
const basic_arg_spec_t pin_values_pwm_args[] = {
    SLICE_ARG,
    {"frequency", BASIC_ARG_NUMBER, BASIC_ARG_ABOVE_MIN, .min = 0, .max = 1e9, .unit = "Hz",
     .help = "of both outputs, from 7.5 to a quarter of the processor's clock"},
    DUTY_ARG("duty_a", "A"),
    DUTY_ARG("duty_b", "B"),
    {"phase", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1,
     .help = "1: the pulses of A and B share their centres"},
    {"defer", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1, .help = "1: PWM SYNC starts it"},
};
const basic_arg_spec_t pin_values_pwm_off_args[] = {
    SLICE_ARG,
    {"off", BASIC_ARG_CHOICE, BASIC_ARG_SELECTS, .choices = "OFF", .help = "both outputs low"},
};
const basic_arg_spec_t pin_values_sync_args[] = {
    SYNC_ARG("slice_0"), SYNC_ARG("slice_1"), SYNC_ARG("slice_2"), SYNC_ARG("slice_3"),
    SYNC_ARG("slice_4"), SYNC_ARG("slice_5"), SYNC_ARG("slice_6"), SYNC_ARG("slice_7"),
};
const basic_arg_spec_t pin_values_servo_args[] = {
    SLICE_ARG,
    POSITION_ARG("position_a", "A"),
    POSITION_ARG("position_b", "B"),
};

// ---- PIN ----------------------------------------------------------------------------------------

err_t pin_values_read(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    io_value_t value;
    err_t err = io_read((unsigned)args[0].integer, &value);
    if (err == ERR_OK && value.is_whole) {
        *result = (basic_value_t){.type = BASIC_INTEGER, .integer = value.whole};
    } else if (err == ERR_OK) {
        *result = (basic_value_t){.type = BASIC_FLOAT, .number = value.number};
    }
    return err;
}

err_t pin_values_temperature(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    *result = (basic_value_t){.type = BASIC_FLOAT, .number = io_temperature()};
    return ERR_OK;
}

err_t pin_values_write(const basic_arg_t *args, size_t count) {
    (void)count;
    return io_write((unsigned)args[1].integer, args[0].integer);
}

err_t pin_values_pulse(const basic_arg_t *args, size_t count) {
    (void)count;
    return io_pulse((unsigned)args[0].integer, args[1].number);
}

// ---- PORT ---------------------------------------------------------------------------------------

typedef struct {
    uint8_t gpio[PINS_COUNT]; // of each bit
    unsigned bits;
    uint32_t pins;
} port_t;

static err_t add_group(port_t *port, unsigned start, unsigned bits) {
    for (unsigned gpio = start; gpio < start + bits; gpio++) {
        if (!pins_is_user(gpio)) {
            return err_raise(ERR_PIN_INVALID, "GP%u in PORT", gpio);
        }
        if ((port->pins & pins_mask(gpio)) != 0) {
            return err_raise(ERR_PIN_TWICE, "%s", pins_name(gpio));
        }
        port->pins |= pins_mask(gpio);
        port->gpio[port->bits++] = (uint8_t)gpio;
    }
    return ERR_OK;
}

static err_t port_of(const basic_arg_t *args, size_t count, port_t *port) {
    *port = (port_t){.bits = 0};
    err_t err = ERR_OK;
    for (size_t i = 0; i + 1 < count && err == ERR_OK; i += 2) {
        err = add_group(port, (unsigned)args[i].integer, (unsigned)args[i + 1].integer);
    }
    return err;
}

err_t pin_values_read_port(const basic_arg_t *args, size_t count, basic_value_t *result) {
    port_t port;
    uint32_t levels = 0;
    err_t err = port_of(args, count, &port);
    if (err == ERR_OK) {
        err = io_read_port(port.pins, &levels);
    }
    for (unsigned bit = 0; bit < port.bits; bit++) {
        result->integer |= (int64_t)(levels >> port.gpio[bit] & 1u) << bit;
    }
    return err;
}

err_t pin_values_write_port(const basic_arg_t *args, size_t count) {
    port_t port;
    err_t err = port_of(args + 1, count - 1, &port);
    if (err != ERR_OK) {
        return err;
    }
    uint32_t levels = 0;
    for (unsigned bit = 0; bit < port.bits; bit++) {
        levels |= (args[0].integer >> bit & 1) != 0 ? pins_mask(port.gpio[bit]) : 0;
    }
    return io_write_port(port.pins, levels);
}

// ---- PWM and SERVO ------------------------------------------------------------------------------

err_t pin_values_pwm(const basic_arg_t *args, size_t count) {
    (void)count;
    io_pwm_t pwm = {
        .frequency_hz = args[1].number,
        .given = {args[2].given, args[3].given},
        .percent = {args[2].number, args[3].number},
        .phase_correct = args[4].integer != 0,
        .defer = args[5].integer != 0,
    };
    return io_pwm((unsigned)args[0].integer, &pwm);
}

err_t pin_values_pwm_off(const basic_arg_t *args, size_t count) {
    (void)count;
    return io_pwm_off((unsigned)args[0].integer);
}

err_t pin_values_sync(const basic_arg_t *args, size_t count) {
    uint32_t slices = 0;
    double percent[HAL_PWM_SLICES] = {0};
    for (size_t slice = 0; slice < count && slice < HAL_PWM_SLICES; slice++) {
        if (args[slice].given && args[slice].number >= 0.0) {
            slices |= 1u << slice;
            percent[slice] = args[slice].number;
        }
    }
    return io_pwm_sync(slices, percent);
}

err_t pin_values_servo(const basic_arg_t *args, size_t count) {
    (void)count;
    const bool given[2] = {args[1].given, args[2].given};
    const double percent[2] = {args[1].number, args[2].number};
    return io_servo((unsigned)args[0].integer, given, percent);
}
