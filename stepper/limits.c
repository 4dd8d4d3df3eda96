// Limit switches: which pins, which are pressed, which of them trip. Context: main loop.
#include "stepper/limits.h"

#include <string.h>

#include "stepper/alarm.h"
#include "stepper/governor.h"
#include "stepper/machine.h"
#include "stepper/rules.h"
#include "stepper/step_isr.h"

// A switch that opens bounces, and one that was pressed when the machine was armed should not trip
// while the axis is taken off it: it has to be released for this long.
#define RELEASED_US 20000u

static struct {
    stepper_safety_t config;
    uint8_t excepted;   // switches that a motion goes to on purpose
    uint8_t overridden; // pressed when the machine was armed
    uint8_t released;   // those of the overridden that were not pressed since `released_us`
    uint64_t released_us;
} limits = {
    .config.switches.gpio = {PINS_NONE, PINS_NONE, PINS_NONE, PINS_NONE, PINS_NONE, PINS_NONE}};

static const char *const owners[STEPPER_SWITCHES] = {
    "STEPPER X_MIN limit", "STEPPER X_MAX limit", "STEPPER Y_MIN limit",
    "STEPPER Y_MAX limit", "STEPPER Z_MIN limit", "STEPPER Z_MAX limit",
};

static const char names[STEPPER_SWITCHES][6] = {"X_MIN", "X_MAX", "Y_MIN",
                                                "Y_MAX", "Z_MIN", "Z_MAX"};

const char *stepper_switch_name(stepper_switch_t which) {
    return names[which];
}

const char *stepper_switch_names(char text[STEPPER_SWITCH_NAMES_SIZE], uint32_t switches) {
    size_t length = 0;
    text[0] = '\0';
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        if ((switches >> n) & 1) {
            length += format_text(text + length, STEPPER_SWITCH_NAMES_SIZE - length, "%s%s",
                                  length > 0 ? ", " : "", names[n]);
        }
    }
    return text;
}

// ---- Pins ---------------------------------------------------------------------------------------

uint32_t limits_pins(uint32_t switches) {
    uint32_t pins = 0;
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        pins |= (switches >> n) & 1 ? pins_mask(limits.config.switches.gpio[n]) : 0;
    }
    return pins;
}

uint32_t limits_switches(uint32_t pins) {
    uint32_t switches = 0;
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        bool among = (pins & pins_mask(limits.config.switches.gpio[n])) != 0;
        switches |= (uint32_t)among << n;
    }
    return switches;
}

uint32_t limits_levels(void) {
    return limits_pins(limits.config.switches.active_high);
}

uint32_t limits_assigned(void) {
    return limits_switches(UINT32_MAX);
}

uint32_t stepper_pressed(void) {
    return machine.initialized ? limits_switches(~(hal_pins_read() ^ limits_levels())) : 0;
}

// ---- What trips ---------------------------------------------------------------------------------

// Makes the tick watch what it has to, and go on or start for it.
static void apply(void) {
    uint32_t silent = limits_pins(limits.excepted | limits.overridden);
    const step_isr_inputs_t inputs = {
        .estop = pins_mask(machine.config.estop_gpio),
        .limits = limits_pins(limits_assigned()) & ~silent,
        .levels = limits_levels(),
        .estop_samples = limits.config.estop_samples,
        .limit_samples = limits.config.limit_samples,
    };
    hal_governor_lock();
    step_isr_watch(&inputs);
    if (governor_armed() && step_isr_watches()) {
        hal_tick_start();
    }
    hal_governor_unlock();
}

static void override(uint32_t switches) {
    limits.overridden = (uint8_t)(switches & ~limits.excepted);
    limits.released = 0;
    machine.limit_active = limits.overridden != 0;
    alarm_look();
    apply();
}

void limits_except(uint32_t switches) {
    limits.excepted = (uint8_t)switches;
    override(limits.overridden | stepper_pressed());
}

void limits_override_pressed(void) {
    override(stepper_pressed());
}

void limits_follow(void) {
    if (limits.overridden == 0) {
        return;
    }
    uint32_t released = limits.overridden & ~stepper_pressed();
    uint64_t now_us = hal_time_us();
    if (released != limits.released) {
        limits.released = (uint8_t)released;
        limits.released_us = now_us;
    } else if (released != 0 && now_us - limits.released_us >= RELEASED_US) {
        override(limits.overridden & ~released);
    }
}

uint32_t stepper_overridden(void) {
    limits_follow();
    return limits.overridden;
}

// ---- Configuration ------------------------------------------------------------------------------

static bool is_ours(const char *owner) {
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        if (owner == owners[n]) {
            return true;
        }
    }
    return false;
}

static err_t check_pin(unsigned n, unsigned gpio) {
    if (!pins_is_user(gpio)) {
        return err_raise(ERR_PIN_INVALID, "GP%u for %s: %s", gpio, names[n], pins_why_not(gpio));
    }
    const char *owner = pins_owner(gpio);
    if (owner != NULL && !is_ours(owner)) {
        return err_raise(ERR_PIN_IN_USE, "%s for %s is in use by %s", pins_name(gpio), names[n],
                         owner);
    }
    return ERR_OK;
}

// Two switches on one pin: only those of one axis, and alike.
static err_t check_shared(const stepper_hwlimits_t *wanted, unsigned a, unsigned b) {
    if (a / 2 != b / 2) {
        return err_raise(ERR_LIMITS_SHARED, "%s: %s and %s", pins_name(wanted->gpio[a]), names[a],
                         names[b]);
    }
    bool alike = ((wanted->active_high >> a) & 1) == ((wanted->active_high >> b) & 1);
    return alike ? ERR_OK : err_raise(ERR_LIMITS_POLARITY, "%s and %s", names[a], names[b]);
}

static err_t check(const stepper_hwlimits_t *wanted) {
    err_t err = ERR_OK;
    for (unsigned n = 0; n < STEPPER_SWITCHES && err == ERR_OK; n++) {
        if (wanted->gpio[n] == PINS_NONE) {
            continue;
        }
        err = check_pin(n, wanted->gpio[n]);
        for (unsigned before = 0; before < n && err == ERR_OK; before++) {
            if (wanted->gpio[before] == wanted->gpio[n]) {
                err = check_shared(wanted, before, n);
            }
        }
    }
    return err;
}

static void take_pins(void) {
    const stepper_hwlimits_t *switches = &limits.config.switches;
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        unsigned gpio = switches->gpio[n];
        if (gpio != PINS_NONE && pins_owner(gpio) == NULL) {
            pins_claim(gpio, owners[n]); // checked before
            bool high = (switches->active_high >> n) & 1;
            hal_pin_input(gpio, high ? HAL_PULL_DOWN : HAL_PULL_UP);
        }
    }
}

static void give_pins_back(void) {
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        unsigned gpio = limits.config.switches.gpio[n];
        if (gpio != PINS_NONE && pins_owner(gpio) != NULL) {
            hal_pin_release(gpio);
            pins_disclaim(gpio);
        }
    }
}

err_t stepper_hwlimits(const stepper_hwlimits_t *config) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err == ERR_OK) {
        err = check(config);
    }
    if (err != ERR_OK) {
        return err;
    }
    limits.overridden = 0;
    limits.excepted = (uint8_t)~0u; // none trips while pins change hands
    apply();
    give_pins_back();
    limits.config.switches = *config;
    take_pins();
    limits.excepted = 0;
    override(governor_armed() ? stepper_pressed() : 0);
    machine_pass_pins_on();
    return ERR_OK;
}

err_t stepper_filter(uint32_t limit_samples, uint32_t estop_samples) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        limits.config.limit_samples = limit_samples;
        limits.config.estop_samples = estop_samples;
        apply();
    }
    return err;
}

err_t stepper_limit_keep(bool keep_enabled) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        limits.config.keep_enabled = keep_enabled;
        machine_pass_keep_on();
    }
    return err;
}

void stepper_safety(stepper_safety_t *config) {
    *config = limits.config;
}

uint32_t limits_latch_samples(void) {
    uint32_t samples = limits.config.limit_samples;
    return samples < STEP_ISR_LATCH_SAMPLES_MAX ? samples : STEP_ISR_LATCH_SAMPLES_MAX;
}

void limits_reset(void) {
    memset(&limits, 0, sizeof limits);
    machine.limit_active = false;
    limits.config.limit_samples = STEPPER_FILTER_LIMITS;
    limits.config.estop_samples = STEPPER_FILTER_ESTOP;
    memset(limits.config.switches.gpio, PINS_NONE, sizeof limits.config.switches.gpio);
    apply();
}

void limits_release(void) {
    give_pins_back();
    limits_reset();
}
