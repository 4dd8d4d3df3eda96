// Probing: a move that ends where an input changes. Context: main loop.
#include "stepper/probing.h"

#include <string.h>

#include "stepper/axis.h"
#include "stepper/cycle.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_safety.h"

static const char probe_owner[] = "STEPPER probe";

static struct {
    uint8_t gpio;
    bool invert; // active high
    bool away;   // until contact is lost
    bool must_change;
    bool moved;                // the move has been made
    bool changed;              // the probe, in the last probing
    float feed;                // units/min
    int32_t steps[AXIS_COUNT]; // the target; then where the probe changed
} probing = {.gpio = PINS_NONE};

err_t stepper_probe_pin(uint8_t gpio, bool invert) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err == ERR_OK && gpio != PINS_NONE && gpio != probing.gpio) {
        err = pins_claim(gpio, probe_owner);
    }
    if (err != ERR_OK) {
        return err;
    }
    if (gpio != probing.gpio) {
        probing_release();
    }
    probing.gpio = gpio;
    probing.invert = invert;
    if (gpio != PINS_NONE) {
        hal_pin_input(gpio, invert ? HAL_PULL_DOWN : HAL_PULL_UP);
    }
    return ERR_OK;
}

void probing_release(void) {
    if (probing.gpio != PINS_NONE) {
        hal_pin_release(probing.gpio);
        pins_disclaim(probing.gpio);
    }
    probing.gpio = PINS_NONE;
}

void probing_reset(void) {
    memset(&probing, 0, sizeof probing);
    probing.gpio = PINS_NONE;
}

uint8_t stepper_probe_config(bool *invert) {
    *invert = probing.invert;
    return probing.gpio;
}

bool stepper_probe_contact(void) {
    uint32_t pin = pins_mask(probing.gpio);
    return pin != 0 && ((hal_pins_read() & pin) != 0) == probing.invert;
}

// ---- The cycle ----------------------------------------------------------------------------------

static err_t check(const stepper_move_t *move, int32_t steps[AXIS_COUNT]) {
    double from[AXIS_COUNT];
    err_t err = rules_check(RULES_DO_PROBE);
    if (err == ERR_OK && probing.gpio == PINS_NONE) {
        err = err_raise(ERR_NO_PROBE_PIN, NULL);
    }
    moves_target(from);
    if (err == ERR_OK) {
        err = stepper_check_line(from, move);
    }
    bool goes = false;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = 0;
        if (axes[axis].configured) {
            axis_to_steps(axis, move->target[axis], &steps[axis]); // it fits: that was checked
        }
        goes = goes || (axis != AXIS_A && move->target[axis] != from[axis]);
    }
    return err == ERR_OK && !goes ? err_raise(ERR_PROBE_NO_WAY, NULL) : err;
}

err_t stepper_probe(const stepper_move_t *move, bool away, bool must_change) {
    int32_t steps[AXIS_COUNT];
    err_t err = check(move, steps);
    if (err != ERR_OK) {
        return err;
    }
    memcpy(probing.steps, steps, sizeof probing.steps);
    probing.feed = (float)move->feed;
    probing.away = away;
    probing.must_change = must_change;
    probing.moved = false;
    probing.changed = false;
    cycle_begin(STEPPER_CYCLE_PROBING);
    return ERR_OK;
}

static void begin(void) {
    if (stepper_probe_contact() != probing.away) {
        cycle_end(probing.away ? CYCLE_NO_CONTACT_BEFORE : CYCLE_CONTACT_BEFORE, 0, 0.0);
        return;
    }
    uint32_t pin = pins_mask(probing.gpio);
    probing.moved = true;
    const cycle_until_t until = {
        .pins = pin,
        .levels = probing.away == probing.invert ? 0 : pin,
    };
    cycle_move(probing.steps, (double)probing.feed, &until);
}

void probing_advance(void) {
    if (!probing.moved) {
        begin();
        return;
    }
    int32_t places[AXIS_COUNT];
    probing.changed = cycle_moved(places) != 0;
    if (!probing.changed) {
        machine_motor_steps(places);
    }
    memcpy(probing.steps, places, sizeof probing.steps);
    bool failed = probing.must_change && !probing.changed;
    cycle_end(!failed ? CYCLE_DONE : probing.away ? CYCLE_CONTACT_KEPT : CYCLE_NO_CONTACT, 0, 0.0);
}

// Stopped on the way: where it stands is all that there is to tell.
void probing_end(bool done) {
    if (!done && !probing.changed) {
        machine_motor_steps(probing.steps);
    }
    stepper_raise_event(STEPPER_EVENT_PROBED);
}

bool stepper_probed(double position[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        position[axis] = axis_from_steps(axis, probing.steps[axis]);
    }
    return probing.changed;
}
