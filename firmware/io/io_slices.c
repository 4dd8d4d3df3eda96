// PWM and servos: a slice of the board makes one frequency and two outputs. Context: main loop.
#include "io_slices.h"

#include "hal/slices.h"
#include "io.h"
#include "io_pins.h"

#define COUNTS_MIN 4u // of a period of a slice without settings

#define SERVO_HZ 50.0
#define SERVO_ZERO_MS 1.0 // the pulse at 0 %, and how much longer it is at 100 %
#define SERVO_SPAN_MS 1.0

static const char owner[] = "PWM";

static struct {
    hal_pwm_t pwm;
    uint8_t gpio[2]; // of A and B, + 1; 0: none
    bool set_up;
    bool running; // a deferred one is only set up
} slices[HAL_PWM_SLICES];

// ---- Pins ---------------------------------------------------------------------------------------

static const char *output_name(unsigned output) {
    static char name[] = "PWM0A";
    name[3] = (char)('0' + output / 2);
    name[4] = (char)('A' + output % 2);
    return name;
}

static err_t check_output(unsigned gpio, unsigned output) {
    unsigned own = HAL_PWM_SLICE(gpio) * 2 + HAL_PWM_CHANNEL(gpio);
    if (output != IO_PWM_ANY && output != own) {
        return err_raise(ERR_PIN_OTHER_PWM, "%s is %s", pins_name(gpio), output_name(own));
    }
    unsigned other = slices[own / 2].gpio[own % 2];
    if (other != 0 && other - 1 != gpio) {
        return err_raise(ERR_PIN_OTHER_PWM, "%s is on %s", output_name(own), pins_name(other - 1));
    }
    return ERR_OK;
}

// Pins of a slice that does not run are plain outputs, low.
static void connect(unsigned slice, bool running) {
    for (unsigned channel = 0; channel < 2; channel++) {
        uint8_t gpio = slices[slice].gpio[channel];
        if (gpio != 0 && running) {
            hal_pin_pwm(gpio - 1u);
        } else if (gpio != 0) {
            hal_pin_output(gpio - 1u, false);
        }
    }
}

static void start(uint32_t mask, const uint16_t counts[HAL_PWM_SLICES]) {
    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        unsigned slice = (unsigned)__builtin_ctz(rest);
        slices[slice].running = true;
        connect(slice, true);
    }
    hal_pwm_start(mask, counts);
}

err_t io_set_pwm(unsigned gpio, unsigned output) {
    err_t err = io_pins_check(gpio);
    if (err == ERR_OK) {
        err = check_output(gpio, output);
    }
    if (err == ERR_OK) {
        err = slices_claim(HAL_PWM_SLICE(gpio), owner);
    }
    if (err == ERR_OK && io_pins_use(gpio) != IO_PINS_PWM) {
        io_pins_take(gpio, IO_PINS_PWM);
        slices[HAL_PWM_SLICE(gpio)].gpio[HAL_PWM_CHANNEL(gpio)] = (uint8_t)(gpio + 1);
        if (slices[HAL_PWM_SLICE(gpio)].running) {
            hal_pin_pwm(gpio);
        } else {
            hal_pin_output(gpio, false);
        }
    }
    return err;
}

static void stop(unsigned slice) {
    slices[slice].set_up = slices[slice].running = false;
    slices[slice].pwm = (hal_pwm_t){.divider_16ths = 16, .top = COUNTS_MIN - 1};
    connect(slice, false);
    hal_pwm_stop(slice);
    hal_pwm_set(slice, &slices[slice].pwm);
}

err_t io_pwm_off(unsigned slice) {
    const char *other = slices_owner(slice);
    if (other != NULL && other != owner) {
        return slices_claim(slice, owner); // says who has it
    }
    stop(slice);
    return ERR_OK;
}

void io_slices_remove(unsigned gpio) {
    unsigned slice = HAL_PWM_SLICE(gpio);
    unsigned channel = HAL_PWM_CHANNEL(gpio);
    slices[slice].gpio[channel] = 0;
    if (slices[slice].gpio[1 - channel] == 0) {
        stop(slice);
        slices_disclaim(slice);
    } else {
        slices[slice].pwm.level[channel] = 0;
        slices[slice].pwm.inverted[channel] = false;
        hal_pwm_set(slice, &slices[slice].pwm);
    }
}

// ---- Settings -----------------------------------------------------------------------------------

static void set_level(hal_pwm_t *pwm, unsigned channel, double percent) {
    double part = (percent < 0.0 ? -percent : percent) / 100.0;
    pwm->level[channel] = (uint16_t)(part * (pwm->top + 1u) + 0.5);
    pwm->inverted[channel] = percent < 0.0;
}

// What a level was worth before the frequency changed.
static double percent_of(const hal_pwm_t *pwm, unsigned channel) {
    double percent = pwm->level[channel] * 100.0 / (pwm->top + 1u);
    return pwm->inverted[channel] ? -percent : percent;
}

static err_t check_pins(unsigned slice, const bool given[2]) {
    const uint8_t *gpio = slices[slice].gpio;
    for (unsigned channel = 0; channel < 2; channel++) {
        if (given[channel] && gpio[channel] == 0) {
            return err_raise(ERR_PWM_NO_PIN, "%s", output_name(slice * 2 + channel));
        }
    }
    if (gpio[0] == 0 && gpio[1] == 0) {
        return err_raise(ERR_PWM_NO_PIN, "PWM%u", slice);
    }
    return ERR_OK;
}

static void begin(unsigned slice, const hal_pwm_t *pwm, bool defer) {
    static const uint16_t zero[HAL_PWM_SLICES];
    slices[slice].pwm = *pwm;
    slices[slice].set_up = true;
    hal_pwm_set(slice, pwm);
    if (!slices[slice].running && !defer) {
        start(1u << slice, zero);
    }
}

err_t io_pwm(unsigned slice, const io_pwm_t *settings) {
    err_t err = check_pins(slice, settings->given);
    if (err != ERR_OK) {
        return err;
    }
    hal_pwm_t pwm = slices[slice].pwm;
    if (slices_divide(hal_clock_hz(), settings->frequency_hz, settings->phase_correct, &pwm) ==
        0.0) {
        double share = settings->phase_correct ? 0.5 : 1.0;
        return err_raise(ERR_PWM_FREQUENCY, "%.1f to %.0f Hz",
                         slices_lowest_hz(hal_clock_hz()) * share,
                         slices_highest_hz(hal_clock_hz()) * share);
    }
    for (unsigned channel = 0; channel < 2; channel++) {
        double before = percent_of(&slices[slice].pwm, channel);
        set_level(&pwm, channel, settings->given[channel] ? settings->percent[channel] : before);
    }
    begin(slice, &pwm, settings->defer);
    return ERR_OK;
}

err_t io_servo(unsigned slice, const bool given[2], const double percent[2]) {
    io_pwm_t settings = {.frequency_hz = SERVO_HZ};
    for (unsigned channel = 0; channel < 2; channel++) {
        double pulse_ms = SERVO_ZERO_MS + SERVO_SPAN_MS * percent[channel] / 100.0;
        settings.given[channel] = given[channel];
        settings.percent[channel] = pulse_ms * SERVO_HZ / 10.0;
    }
    return io_pwm(slice, &settings);
}

err_t io_pwm_sync(uint32_t mask, const double percent[HAL_PWM_SLICES]) {
    uint16_t counts[HAL_PWM_SLICES] = {0};
    for (unsigned slice = 0; slice < HAL_PWM_SLICES; slice++) {
        if ((mask >> slice & 1u) == 0) {
            continue;
        }
        if (!slices[slice].set_up) {
            return err_raise(ERR_PWM_NOT_SET_UP, "%u", slice);
        }
        counts[slice] = (uint16_t)(percent[slice] / 100.0 * slices[slice].pwm.top);
    }
    start(mask, counts);
    return ERR_OK;
}
