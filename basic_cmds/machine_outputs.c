// Spindle, coolant and pauses: what the user is told about them. Context: main loop.
#include "basic_cmds/machine_outputs.h"

#include "basic_cmds/report.h"
#include "gcode/gcode.h"
#include "stepper/stepper_outputs.h"

static const char *const laser_modes[] = {
    [STEPPER_SPINDLE_OFF] = "M5",
    [STEPPER_SPINDLE_CW] = "M3",
    [STEPPER_SPINDLE_CCW] = "M4",
};

void machine_outputs_report(void) {
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    const stepper_spindle_t *spindle = &outputs.spindle;
    basic_printf("Spindle: %s%s, %s", pins_name(spindle->gpio), spindle->invert ? " inverted" : "",
                 report_on_off(outputs.spindle_on));
    if (spindle->gpio != PINS_NONE && spindle->max_rpm > 0.0) {
        basic_printf(" %.0f rpm of %.0f to %.0f, PWM %g Hz", outputs.rpm, spindle->min_rpm,
                     spindle->max_rpm, spindle->pwm_hz);
    }
    if (outputs.laser) {
        basic_printf(", laser %s", laser_modes[outputs.turn]);
    } else if (spindle->dir_gpio != PINS_NONE) {
        basic_printf(", dir %s %s", pins_name(spindle->dir_gpio),
                     outputs.turn == STEPPER_SPINDLE_CCW ? "CCW" : "CW");
    }
    if (spindle->spinup_ms > 0 && !outputs.laser) {
        basic_printf(", spin-up %u ms", (unsigned)spindle->spinup_ms);
    }
    basic_printf("\n");
    const stepper_coolant_t *coolant = &outputs.coolant;
    if (coolant->flood_gpio != PINS_NONE || coolant->mist_gpio != PINS_NONE) {
        basic_printf("Coolant: flood %s %s, mist %s %s%s\n", pins_name(coolant->flood_gpio),
                     report_on_off(outputs.flood), pins_name(coolant->mist_gpio),
                     report_on_off(outputs.mist), coolant->invert ? ", inverted" : "");
    }
}

err_t machine_outputs_peek_spindle(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    bool pwm = outputs.spindle.gpio != PINS_NONE && outputs.spindle.max_rpm > 0.0;
    double speed = pwm ? outputs.rpm : (double)outputs.spindle_on;
    bool reverse = !outputs.laser && outputs.turn == STEPPER_SPINDLE_CCW && speed > 0.0;
    *result = (basic_value_t){.type = BASIC_FLOAT, .number = reverse ? -speed : speed};
    return ERR_OK;
}

err_t machine_outputs_peek_coolant(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    int64_t bits = (outputs.mist ? 1 : 0) | (outputs.flood ? 2 : 0);
    *result = (basic_value_t){.type = BASIC_INTEGER, .integer = bits};
    return ERR_OK;
}

void machine_outputs_background(void) {
    if (stepper_spindle_limited()) {
        basic_notice("Warning: S is above the spindle's max_rpm and limited to it");
    }
}

void machine_outputs_tell_pause(void) {
    uint32_t tool;
    if (gcode_take_pause(&tool) && tool != GCODE_NO_TOOL) {
        basic_notice("Tool %u: change it, then Ctrl-R or STEPPER RESUME", (unsigned)tool);
    } else {
        basic_notice("Paused (Ctrl-R or STEPPER RESUME goes on)");
    }
}
