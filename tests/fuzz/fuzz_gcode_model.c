// A model of what right lines do.
#include "fuzz_gcode_model.h"

#include <string.h>

#include "fuzz_session.h"
#include "gcode/gcode.h"

fuzz_gcode_model_t fuzz_gcode_model;

double fuzz_gcode_model_offset(axis_id_t axis) {
    double offset = fuzz_gcode_model.systems[fuzz_gcode_model.modal.system][axis] +
                    fuzz_gcode_model.shift[axis];
    return axis == AXIS_Z ? offset + fuzz_gcode_model.length_mm : offset;
}

void fuzz_gcode_model_follow_machine(void) {
    stepper_status_t status;
    stepper_status(&status);
    fuzz_gcode_model.stop_pending = status.stopping;
    stepper_target(fuzz_gcode_model.target);
}

static void follow_origin(const fuzz_gcode_line_t *line, axis_id_t axis) {
    double value = line->value[axis];
    uint32_t system = line->table > 0 ? line->table - 1 : fuzz_gcode_model.modal.system;
    if (line->kind == FUZZ_GCODE_SYSTEM) {
        fuzz_gcode_model.systems[system][axis] = value;
    } else {
        double base = fuzz_gcode_model.systems[fuzz_gcode_model.modal.system][axis];
        base = axis == AXIS_Z ? base + fuzz_gcode_model.length_mm : base;
        fuzz_gcode_model.shift[axis] = fuzz_gcode_model.target[axis] - base - value;
    }
}

static void follow_axis(const fuzz_gcode_line_t *line, axis_id_t axis) {
    double value = line->value[axis];
    if (line->kind != FUZZ_GCODE_MOVE) {
        follow_origin(line, axis);
    } else if (line->machine) {
        fuzz_gcode_model.target[axis] = value;
    } else {
        fuzz_gcode_model.target[axis] = value + (line->relative ? fuzz_gcode_model.target[axis]
                                                                : fuzz_gcode_model_offset(axis));
    }
}

void fuzz_gcode_model_follow(const fuzz_gcode_line_t *line) {
    fuzz_gcode_model.modal.system = line->system;
    if (line->kind == FUZZ_GCODE_LENGTH) {
        fuzz_gcode_model.length_mm = line->length_mm;
    }
    if (line->kind == FUZZ_GCODE_OFFSET_CLEAR) {
        memset(fuzz_gcode_model.shift, 0, sizeof fuzz_gcode_model.shift);
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((line->axes >> axis) & 1) {
            follow_axis(line, axis);
        }
    }
    fuzz_gcode_model.modal.relative = line->relative;
    fuzz_gcode_model.modal.inches = line->inches;
    fuzz_gcode_model.modal.has_feed |= line->feed > 0;
    if (line->arc) {
        fuzz_gcode_model.modal.has_motion = false; // not one that a line without G could go on with
    }
    if (line->sets_motion) {
        fuzz_gcode_model.modal.has_motion = true;
        fuzz_gcode_model.modal.rapid = line->rapid;
    }
}

void fuzz_gcode_model_check(void) {
    double target[AXIS_COUNT];
    stepper_target(target);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        FUZZ_SESSION_CHECK(target[axis] == fuzz_gcode_model.target[axis],
                           "axis %d: target %.17g, should be %.17g", axis, target[axis],
                           fuzz_gcode_model.target[axis]);
        FUZZ_SESSION_CHECK(gcode_offset(axis) == fuzz_gcode_model_offset(axis),
                           "axis %d: offset %.17g, should be %.17g", axis, gcode_offset(axis),
                           fuzz_gcode_model_offset(axis));
    }
}

void fuzz_gcode_model_clear_origins(void) {
    memset(fuzz_gcode_model.systems, 0, sizeof fuzz_gcode_model.systems);
    memset(fuzz_gcode_model.shift, 0, sizeof fuzz_gcode_model.shift);
    fuzz_gcode_model.length_mm = 0.0;
}
