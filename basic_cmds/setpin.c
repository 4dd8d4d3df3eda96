// SETPIN: what a pin is used for. Context: main loop.
#include "basic_cmds/setpin.h"

#include "basic_cmds/events.h"
#include "io/io.h"

#define OPTIONAL BASIC_ARG_OPTIONAL
#define DEFAULTS (BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT)

#define PIN_ARG {"pin", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER, .help = "the pin"}
#define USE_ARG(words, text)                                                                       \
    {"use", BASIC_ARG_CHOICE, BASIC_ARG_SELECTS, .choices = words, .help = text}
#define PULL_ARG                                                                                   \
    {"pull", BASIC_ARG_CHOICE, OPTIONAL, .choices = "PULLUP|PULLDOWN",                             \
     .help = "resistor of the chip that holds an open input"}

const basic_arg_spec_t setpin_off_args[] = {
    PIN_ARG,
    USE_ARG("OFF", "not in use, as after a reset"),
};
const basic_arg_spec_t setpin_input_args[] = {
    PIN_ARG,
    USE_ARG("DIN", "digital input, 0 or 1"),
    PULL_ARG,
};
const basic_arg_spec_t setpin_output_args[] = {
    PIN_ARG,
    USE_ARG("DOUT", "digital output, low at first"),
};
const basic_arg_spec_t setpin_analog_args[] = {
    PIN_ARG,
    USE_ARG("AIN|ARAW", "analog input of GP26, GP27, GP28: volts, or counts from 0 to 4095"),
};
const basic_arg_spec_t setpin_frequency_args[] = {
    PIN_ARG,
    USE_ARG("FIN", "frequency in Hz; 0 until the first gate has closed"),
    {"gate", BASIC_ARG_INTEGER, DEFAULTS, .min = 10, .max = 100000, .fallback = 1000, .unit = "ms",
     .help = "how long edges are counted for one reading"},
};
const basic_arg_spec_t setpin_period_args[] = {
    PIN_ARG,
    USE_ARG("PIN", "period in ms; 0 until the first is over"),
    {"periods", BASIC_ARG_INTEGER, DEFAULTS, .min = 1, .max = 10000, .fallback = 1,
     .help = "how many make the mean for one reading"},
};
const basic_arg_spec_t setpin_counter_args[] = {
    PIN_ARG,
    USE_ARG("CIN", "counts edges; PIN(pin) = 0 sets the count"),
    {"edges", BASIC_ARG_INTEGER, DEFAULTS, .min = 1, .max = 5, .fallback = 1,
     .help =
         "1: rising, with pull-down; 2: falling, with pull-up; 3: both; 4: both, with pull-down; "
         "5: both, with pull-up"},
};
const basic_arg_spec_t setpin_interrupt_args[] = {
    PIN_ARG,
    USE_ARG("INTH|INTL|INTB", "input that calls a SUB when it rises, falls, or either"),
    {"sub", BASIC_ARG_ROUTINE, .help = "the SUB, which has no parameters"},
    PULL_ARG,
};
const basic_arg_spec_t setpin_pwm_args[] = {
    PIN_ARG,
    USE_ARG(
        "PWM|PWM0A|PWM0B|PWM1A|PWM1B|PWM2A|PWM2B|PWM3A|PWM3B|PWM4A|PWM4B|PWM5A|PWM5B|PWM6A|PWM6B|"
        "PWM7A|PWM7B",
        "output for PWM and SERVO: that of this slice, or whichever the pin has"),
};

// The words in the order of BASIC_PIN_NUMBERS_GPIO and its companions.
const basic_arg_spec_t setpin_numbers_args[] = {
    {"rule", BASIC_ARG_CHOICE, .choices = "GPIO|BOARD|MIXED",
     .help = "GPIO numbers, or numbers on the board; MIXED: GPIO in STEPPER and "
             "TMC22xx, BOARD in SETPIN and PIN"},
};
const basic_arg_spec_t setpin_vcc_args[] = {
    {"volts", BASIC_ARG_NUMBER, .min = 1.8, .max = 3.6, .unit = "V",
     .help = "voltage that an analog input reads as full scale; RUN sets 3.3"},
};

// ---- Interrupts ---------------------------------------------------------------------------------

// Each is an event of the language; the pin's GPIO + 1, 0: free.
static uint8_t interrupts[EVENTS_PINS_COUNT];

static unsigned slot_of(unsigned gpio_plus_1) {
    unsigned slot = 0;
    while (slot < EVENTS_PINS_COUNT && interrupts[slot] != gpio_plus_1) {
        slot++;
    }
    return slot;
}

void setpin_forget_interrupt(unsigned gpio) {
    unsigned slot = slot_of(gpio + 1);
    if (slot < EVENTS_PINS_COUNT) {
        interrupts[slot] = 0;
        basic_set_event(EVENTS_PINS + slot, 0);
    }
}

void setpin_background(void) {
    for (uint32_t changed = io_changed(); changed != 0; changed &= changed - 1) {
        unsigned slot = slot_of((unsigned)__builtin_ctz(changed) + 1);
        if (slot < EVENTS_PINS_COUNT) {
            basic_raise_event(EVENTS_PINS + slot);
        }
    }
}

void setpin_clear(void) {
    for (unsigned slot = 0; slot < EVENTS_PINS_COUNT; slot++) {
        interrupts[slot] = 0;
    }
    io_reset();
}

// ---- Handlers -----------------------------------------------------------------------------------

static unsigned gpio_of(const basic_arg_t *args) {
    return (unsigned)args[0].integer;
}

static hal_pull_t pull_of(const basic_arg_t *arg) {
    return !arg->given ? HAL_PULL_NONE : arg->integer == 0 ? HAL_PULL_UP : HAL_PULL_DOWN;
}

static err_t with_new_use(const basic_arg_t *args, err_t err) {
    if (err == ERR_OK) {
        setpin_forget_interrupt(gpio_of(args));
    }
    return err;
}

err_t setpin_off(const basic_arg_t *args, size_t count) {
    (void)count;
    return with_new_use(args, io_set_off(gpio_of(args)));
}

err_t setpin_input(const basic_arg_t *args, size_t count) {
    (void)count;
    return with_new_use(args, io_set_input(gpio_of(args), pull_of(&args[2])));
}

err_t setpin_output(const basic_arg_t *args, size_t count) {
    (void)count;
    return with_new_use(args, io_set_output(gpio_of(args)));
}

err_t setpin_analog(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned gpio = gpio_of(args);
    return with_new_use(args, args[1].integer == 0 ? io_set_voltage(gpio) : io_set_raw(gpio));
}

err_t setpin_frequency(const basic_arg_t *args, size_t count) {
    (void)count;
    return with_new_use(args, io_set_frequency(gpio_of(args), (uint32_t)args[2].integer));
}

err_t setpin_period(const basic_arg_t *args, size_t count) {
    (void)count;
    return with_new_use(args, io_set_period(gpio_of(args), (uint32_t)args[2].integer));
}

err_t setpin_counter(const basic_arg_t *args, size_t count) {
    (void)count;
    static const struct {
        hal_edge_t edges;
        hal_pull_t pull;
    } options[] = {
        {HAL_EDGE_RISING, HAL_PULL_DOWN}, {HAL_EDGE_FALLING, HAL_PULL_UP},
        {HAL_EDGE_BOTH, HAL_PULL_NONE},   {HAL_EDGE_BOTH, HAL_PULL_DOWN},
        {HAL_EDGE_BOTH, HAL_PULL_UP},
    };
    int64_t option = args[2].integer - 1;
    return with_new_use(args,
                        io_set_counter(gpio_of(args), options[option].edges, options[option].pull));
}

err_t setpin_interrupt(const basic_arg_t *args, size_t count) {
    (void)count;
    static const hal_edge_t edges[] = {HAL_EDGE_RISING, HAL_EDGE_FALLING, HAL_EDGE_BOTH};
    unsigned gpio = gpio_of(args);
    unsigned slot = slot_of(gpio + 1);
    slot = slot < EVENTS_PINS_COUNT ? slot : slot_of(0);
    if (slot == EVENTS_PINS_COUNT) {
        return err_raise(ERR_TOO_MANY_INTERRUPTS, NULL);
    }
    err_t err = io_set_interrupt(gpio, edges[args[1].integer], pull_of(&args[3]));
    if (err == ERR_OK) {
        interrupts[slot] = (uint8_t)(gpio + 1);
        basic_set_event(EVENTS_PINS + slot, (basic_routine_t)args[2].integer);
    }
    return err;
}

err_t setpin_pwm(const basic_arg_t *args, size_t count) {
    (void)count;
    int64_t word = args[1].integer;
    return with_new_use(args,
                        io_set_pwm(gpio_of(args), word == 0 ? IO_PWM_ANY : (unsigned)word - 1));
}

err_t setpin_numbers(const basic_arg_t *args, size_t count) {
    (void)count;
    return basic_set_option(BASIC_PIN_NUMBERS, args[0].integer);
}

err_t setpin_vcc(const basic_arg_t *args, size_t count) {
    (void)count;
    io_set_reference(args[0].number);
    return ERR_OK;
}
