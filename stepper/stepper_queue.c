// Entries of the motion queue, checked before they are queued. Context: main loop.
#include <math.h>

#include "stepper/axis.h"
#include "stepper/machine.h"
#include "stepper/planner.h"

#define TICKS_PER_MS (HAL_TICK_HZ / 1000.0)

static err_t check_target(const stepper_move_t *move, int32_t steps[AXIS_COUNT]) {
    double from[AXIS_COUNT];
    planner_target(from);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double target = move->target[axis];
        steps[axis] = 0;
        if (!axes[axis].configured) {
            if (target != from[axis]) {
                return machine_check_axis(axis);
            }
            continue;
        }
        // Half a step of tolerance: a limit that is no whole step must not refuse its own value.
        double tolerance = 0.5 / axes[axis].config.steps_per_unit;
        if (axes[axis].limited && target != from[axis] &&
            (target < axes[axis].min - tolerance || target > axes[axis].max + tolerance)) {
            return err_raise(ERR_SOFT_LIMIT, "%c", STEPPER_AXIS_LETTERS[axis]);
        }
        if (!axis_to_steps(axis, target, &steps[axis])) {
            return err_raise(ERR_AXIS_TOO_FAR, "%c", STEPPER_AXIS_LETTERS[axis]);
        }
    }
    return ERR_OK;
}

err_t stepper_move(const stepper_move_t *move) {
    err_t err = machine_check_queue();
    if (err != ERR_OK) {
        return err;
    }
    if (!machine.position_known) {
        return err_raise(ERR_POSITION_UNKNOWN, NULL);
    }
    int32_t steps[AXIS_COUNT];
    err = check_target(move, steps);
    if (err == ERR_OK) {
        planner_push_line(move, steps);
        hal_governor_request();
    }
    return err;
}

err_t stepper_dwell(double milliseconds) {
    err_t err = machine_check_queue();
    if (err == ERR_OK) {
        planner_push_dwell((uint32_t)ceil(milliseconds * TICKS_PER_MS));
        hal_governor_request();
    }
    return err;
}

err_t stepper_spindle_switch(bool on) {
    err_t err = machine_check_queue();
    if (err != ERR_OK) {
        return err;
    }
    if (machine.spindle_gpio == PINS_NONE) {
        return err_raise(ERR_NO_SPINDLE_PIN, NULL);
    }
    uint32_t mask = pins_mask(machine.spindle_gpio);
    bool high = on != machine.spindle_invert;
    planner_push_pins(high ? mask : 0, high ? 0 : mask);
    hal_governor_request();
    return ERR_OK;
}

void stepper_target(double target[AXIS_COUNT]) {
    machine_follow_stops();
    planner_target(target);
}
