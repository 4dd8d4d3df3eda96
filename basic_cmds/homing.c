// STEPPER HOME, HOME ORDER, HOME RUN, PROBE, PEEK(STEPPER PROBE ...). Context: main loop.
#include "basic_cmds/homing.h"

#include <ctype.h>
#include <string.h>

#include "basic_cmds/job.h"
#include "gcode/gcode.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_homing.h"

// Homing that STEPPER HOME RUN has begun: no statement waits for it.
static bool untold;

err_t homing_configure(const basic_arg_t *args, size_t count) {
    (void)count;
    stepper_home_t home = {
        .end = STEPPER_HOME_AUTO,
        .seek = args[HOME_SEEK].number,
        .latch = args[HOME_LATCH].given ? args[HOME_LATCH].number : STEPPER_HOME_LATCH,
        .pull_off_mm = args[HOME_PULL_OFF].number,
        .max_travel_mm = args[HOME_TRAVEL].number,
        .position_mm = args[HOME_POSITION].number,
    };
    if (args[HOME_END].given) {
        home.end = args[HOME_END].integer == 0 ? STEPPER_HOME_MIN : STEPPER_HOME_MAX;
    }
    return stepper_home_config((axis_id_t)args[HOME_AXIS].integer, &home);
}

// The axis of a letter; STEPPER_HOME_AXES: none that is homed.
static unsigned axis_of(char letter) {
    unsigned axis = 0;
    while (axis < STEPPER_HOME_AXES &&
           STEPPER_AXIS_LETTERS[axis] != (char)toupper((unsigned char)letter)) {
        axis++;
    }
    return axis;
}

static err_t bad_axis(char letter) {
    return err_raise(ERR_ARGUMENT, "axes: '%c' is none that is homed (valid is X, Y and Z)",
                     letter);
}

// Groups of letters, one for each argument or with commas between; blanks do not matter.
err_t homing_order(const basic_arg_t *args, size_t count) {
    uint8_t groups[STEPPER_HOME_AXES] = {0};
    uint32_t seen = 0;
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const basic_text_t *text = &args[i].text;
        for (size_t n = 0; n < text->length; n++) {
            char letter = text->text[n];
            unsigned axis = axis_of(letter);
            if (letter == ' ' || letter == ',') {
                used += letter == ',' && used < STEPPER_HOME_AXES && groups[used] != 0;
                continue;
            }
            if (axis == STEPPER_HOME_AXES) {
                return bad_axis(letter);
            }
            if ((seen >> axis) & 1) {
                return err_raise(ERR_HOME_ORDER, NULL);
            }
            seen |= 1u << axis;
            groups[used] |= (uint8_t)(1u << axis);
        }
        used += used < STEPPER_HOME_AXES && groups[used] != 0;
    }
    return stepper_home_order(groups);
}

err_t homing_run(const basic_arg_t *args, size_t count) {
    (void)count;
    const basic_text_t *text = &args[0].text;
    uint32_t axes = 0;
    for (size_t n = 0; args[0].given && n < text->length; n++) {
        unsigned axis = axis_of(text->text[n]);
        if (axis == STEPPER_HOME_AXES) {
            return bad_axis(text->text[n]);
        }
        axes |= 1u << axis;
    }
    err_t err = job_check_free();
    if (err == ERR_OK) {
        err = stepper_home(axes);
    }
    untold = untold || err == ERR_OK;
    return err;
}

err_t homing_probe_pin(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_probe_pin((uint8_t)args[0].integer, args[1].integer != 0);
}

err_t homing_peek_probe(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    int64_t what = args[0].integer;
    double position[AXIS_COUNT];
    bool changed = stepper_probed(position);
    if (what >= AXIS_COUNT) {
        bool value = what == AXIS_COUNT ? changed : stepper_probe_contact();
        *result = (basic_value_t){.type = BASIC_INTEGER, .integer = value};
        return ERR_OK;
    }
    axis_id_t axis = (axis_id_t)what;
    err_t err = stepper_check_axis(axis);
    if (err == ERR_OK) {
        double number = position[axis] - gcode_offset(axis);
        *result = (basic_value_t){.type = BASIC_FLOAT, .number = number};
    }
    return err;
}

// ---- The end of a cycle -------------------------------------------------------------------------

static void tell_end(void) {
    untold = false;
    if (stepper_cycle_result() != ERR_OK) {
        basic_notice("%s", err_message());
    }
}

void homing_background(void) {
    if (stepper_cycle() == STEPPER_CYCLE_NONE && !untold) {
        stepper_background();
        return;
    }
    err_kept_t kept; // the statement in the foreground may be about to tell its error
    err_keep(&kept);
    stepper_background();
    if (untold && stepper_cycle() == STEPPER_CYCLE_NONE) {
        tell_end();
    }
    err_put_back(&kept);
}

static void print_axes(const char *before, uint32_t axes) {
    basic_printf("%s", before);
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        if ((axes >> axis) & 1) {
            basic_printf("%c", STEPPER_AXIS_LETTERS[axis]);
        }
    }
}

// Nothing if it has no switch.
static void print_axis(axis_id_t axis) {
    stepper_home_t home;
    stepper_home_settings(axis, &home);
    if (!stepper_axis_configured(axis) || home.end == STEPPER_HOME_AUTO) {
        return;
    }
    basic_printf("%c home: %s, seek %.6g mm/min, latch %.6g mm/min, pull-off %.6g mm, "
                 "travel %.6g mm, ends at %.6g mm\n",
                 STEPPER_AXIS_LETTERS[axis], home.end == STEPPER_HOME_MAX ? "MAX" : "MIN",
                 home.seek, home.latch, home.pull_off_mm, home.max_travel_mm, home.position_mm);
}

static void print_order(void) {
    uint8_t groups[STEPPER_HOME_AXES];
    stepper_home_groups(groups);
    basic_printf("Home order: ");
    for (unsigned n = 0; n < STEPPER_HOME_AXES && groups[n] != 0; n++) {
        print_axes(n > 0 ? ", " : "", groups[n]);
    }
    basic_printf("\n");
}

static void print_probe(void) {
    bool invert;
    uint8_t gpio = stepper_probe_config(&invert);
    if (gpio != PINS_NONE) {
        basic_printf("Probe: %s%s%s\n", pins_name(gpio), invert ? " active high" : "",
                     stepper_probe_contact() ? ", contact" : "");
    }
}

void homing_print_status(void) {
    uint32_t homing;
    const char *doing = stepper_homing_phase(&homing);
    if (stepper_cycle() == STEPPER_CYCLE_HOMING) {
        print_axes("Homing ", homing);
        basic_printf(": %s\n", doing);
    } else if (stepper_cycle() == STEPPER_CYCLE_PROBING) {
        basic_printf("Probing\n");
    }
    print_order();
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        print_axis(axis);
    }
    print_probe();
}
