// Axis configuration: pins, scale, limits. Context: main loop.
#include "stepper/axis.h"

#include <math.h>

#define SECONDS_PER_MINUTE 60.0
#define PINS_PER_AXIS 3
#define ENABLE_ROLE 2

axis_t axes[AXIS_COUNT];

// pins_claim() keeps a pointer, so the owner's name must be a constant.
static const char *const owners[AXIS_COUNT][PINS_PER_AXIS] = {
    {"STEPPER X step", "STEPPER X dir", "STEPPER X enable"},
    {"STEPPER Y step", "STEPPER Y dir", "STEPPER Y enable"},
    {"STEPPER Z step", "STEPPER Z dir", "STEPPER Z enable"},
    {"STEPPER A step", "STEPPER A dir", "STEPPER A enable"},
};

static void list_pins(const stepper_axis_t *config, uint8_t gpios[PINS_PER_AXIS]) {
    gpios[0] = config->step_gpio;
    gpios[1] = config->dir_gpio;
    gpios[ENABLE_ROLE] = config->enable_gpio;
}

static bool axis_owns(axis_id_t axis, unsigned gpio) {
    for (unsigned role = 0; role < PINS_PER_AXIS; role++) {
        if (pins_owner(gpio) == owners[axis][role]) {
            return true;
        }
    }
    return false;
}

// Everything that can be refused is refused here, before the first change.
static err_t check_pins(axis_id_t axis, const uint8_t gpios[PINS_PER_AXIS]) {
    for (unsigned role = 0; role < PINS_PER_AXIS; role++) {
        if (gpios[role] == PINS_NONE) {
            continue;
        }
        if (!pins_is_user(gpios[role])) {
            return err_raise(ERR_PIN_INVALID, "GP%u", gpios[role]);
        }
        for (unsigned other = 0; other < role; other++) {
            if (gpios[role] == gpios[other]) {
                return err_raise(ERR_PIN_IN_USE, "%s is given twice", pins_name(gpios[role]));
            }
        }
        if (pins_owner(gpios[role]) != NULL && !axis_owns(axis, gpios[role])) {
            return err_raise(ERR_PIN_IN_USE, "%s is in use by %s", pins_name(gpios[role]),
                             pins_owner(gpios[role]));
        }
    }
    return ERR_OK;
}

// A driver whose pin nobody has must not wake up by itself: its enable input stays pulled to off.
static void give_back(unsigned role, uint8_t gpio) {
    if (role == ENABLE_ROLE) {
        hal_pin_input(gpio, HAL_PULL_UP);
    } else {
        hal_pin_release(gpio);
    }
    pins_disclaim(gpio);
}

static void release(axis_id_t axis) {
    if (!axes[axis].configured) {
        return;
    }
    uint8_t gpios[PINS_PER_AXIS];
    list_pins(&axes[axis].config, gpios);
    for (unsigned role = 0; role < PINS_PER_AXIS; role++) {
        if (gpios[role] != PINS_NONE) {
            give_back(role, gpios[role]);
        }
    }
    axes[axis] = (axis_t){0};
}

void axis_tune(axis_id_t axis, const stepper_axis_t *config) {
    axis_t *a = &axes[axis];
    double velocity = fmin(config->max_velocity / SECONDS_PER_MINUTE,
                           STEPPER_STEP_RATE_MAX_HZ / config->steps_per_unit);
    a->configured = true;
    a->config = *config;
    a->velocity = (float)velocity;
    a->acceleration = (float)config->max_acceleration;
}

err_t axis_configure(axis_id_t axis, const stepper_axis_t *config) {
    uint8_t gpios[PINS_PER_AXIS];
    list_pins(config, gpios);
    err_t err = check_pins(axis, gpios);
    if (err != ERR_OK) {
        return err;
    }
    stepper_axis_t wanted = *config; // the caller may hand us our own copy, which release() clears
    const axis_t before = axes[axis];
    release(axis);
    for (unsigned role = 0; role < PINS_PER_AXIS; role++) {
        if (gpios[role] != PINS_NONE) {
            pins_claim(gpios[role], owners[axis][role]);
        }
    }
    hal_pin_output(wanted.step_gpio, false);
    hal_pin_output(wanted.dir_gpio, !wanted.dir_invert);
    if (wanted.enable_gpio != PINS_NONE) {
        hal_pin_output(wanted.enable_gpio, true);
    }
    axis_tune(axis, &wanted);
    axes[axis].limited = before.limited; // the working area is still the same
    axes[axis].min = before.min;
    axes[axis].max = before.max;
    return ERR_OK;
}

void axis_release_all(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        release(axis);
    }
}

bool axis_to_steps(axis_id_t axis, double position, int32_t *steps) {
    double exact = round(position * axes[axis].config.steps_per_unit);
    if (!(fabs(exact) <= AXIS_STEPS_MAX)) {
        return false;
    }
    *steps = (int32_t)exact;
    return true;
}

double axis_from_steps(axis_id_t axis, int32_t steps) {
    return axes[axis].configured ? steps / axes[axis].config.steps_per_unit : 0.0;
}

uint32_t axis_enable_mask(void) {
    uint32_t mask = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        mask |= axes[axis].configured ? pins_mask(axes[axis].config.enable_gpio) : 0;
    }
    return mask;
}

uint32_t axis_step_mask(axis_id_t axis) {
    return axes[axis].configured ? pins_mask(axes[axis].config.step_gpio) : 0;
}
