// Homing and probing, as long as there are no inputs to home or probe to. Context: main loop.
#include <string.h>

#include "stepper/home_config.h"
#include "stepper/machine.h"

stepper_cycle_t stepper_cycle(void) {
    return STEPPER_CYCLE_NONE;
}

err_t stepper_cycle_result(void) {
    return ERR_OK;
}

void stepper_background(void) {}

err_t stepper_home(uint32_t axes) {
    err_t err = machine_check_initialized();
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES && err == ERR_OK; axis++) {
        home_switch_t found;
        if (((axes >> axis) & 1) && !home_config_switch(axis, &found)) {
            err = err_raise(ERR_HOME_NO_SWITCH, "%c", STEPPER_AXIS_LETTERS[axis]);
        }
    }
    return err == ERR_OK ? err_raise(ERR_HOME_NO_SWITCH, "No axis") : err;
}

const char *stepper_homing_phase(uint32_t *axes) {
    *axes = 0;
    return "";
}

void stepper_homing_set_hook(void (*arm)(uint32_t axes, bool on)) {
    (void)arm;
}

err_t stepper_probe_pin(uint8_t gpio, bool invert) {
    (void)gpio;
    (void)invert;
    return err_raise(ERR_NO_PROBE_PIN, NULL);
}

err_t stepper_probe(const stepper_move_t *move, bool away, bool must_change) {
    (void)move;
    (void)away;
    (void)must_change;
    return err_raise(ERR_NO_PROBE_PIN, NULL);
}

bool stepper_probed(double position[AXIS_COUNT]) {
    memset(position, 0, AXIS_COUNT * sizeof *position);
    return false;
}

uint8_t stepper_probe_config(bool *invert) {
    *invert = false;
    return PINS_NONE;
}

bool stepper_probe_contact(void) {
    return false;
}
