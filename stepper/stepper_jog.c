// Jogging, as far as it may go. Context: main loop.
#include <math.h>

#include "stepper/alarm.h"
#include "stepper/axis.h"
#include "stepper/geometry.h"
#include "stepper/governor.h"
#include "stepper/jog.h"
#include "stepper/machine.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"

static err_t check(axis_id_t axis) {
    err_t err = rules_check(RULES_DO_JOG);
    return err == ERR_OK ? stepper_check_axis(axis) : err;
}

// As long as a switch of the axis is pressed that does not trip, the way goes off it. Of two on one
// pin nobody knows which one it is.
static err_t check_switches(axis_id_t axis, double distance) {
    uint32_t pressed = axis < AXIS_A ? (stepper_overridden() >> (2 * axis)) & 3 : 0;
    uint32_t ahead = distance < 0.0 ? 1 : 2; // min or max
    if (pressed != ahead) {
        return ERR_OK;
    }
    unsigned which = 2u * axis + (ahead == 2);
    return err_raise(ERR_LIMIT_ACTIVE, "%s", stepper_switch_name((stepper_switch_t)which));
}

// Where the jog ends: within the soft limits, but an axis that stands outside them is not pulled
// in.
static int32_t find_target(axis_id_t axis, double from, double distance) {
    const axis_t *a = &axes[axis];
    double target = from + distance;
    if (a->limited && machine.position_known) {
        target = distance > 0.0 ? fmin(target, fmax(a->max, from)) : target;
        target = distance < 0.0 ? fmax(target, fmin(a->min, from)) : target;
    }
    double steps = round(target * a->config.steps_per_unit);
    return (int32_t)fmax(-AXIS_STEPS_MAX, fmin(AXIS_STEPS_MAX, steps));
}

err_t stepper_jog(axis_id_t axis, double distance, double feed) {
    err_t err = check(axis);
    if (err == ERR_OK) {
        err = check_switches(axis, distance);
    }
    if (err != ERR_OK) {
        return err;
    }
    const geometry_settings_t *settings = &geometry_settings;
    float jerk = settings->axis_jerk[axis] > 0.0f ? fminf(settings->jerk, settings->axis_jerk[axis])
                                                  : settings->jerk;
    jog_request_t request = {
        .axis = axis,
        .target = find_target(axis, stepper_position(axis), distance),
        .units = (float)(1.0 / axes[axis].config.steps_per_unit),
        .speed =
            feed > 0.0 ? fminf((float)(feed / 60.0), axes[axis].velocity) : axes[axis].velocity,
        .acceleration = axes[axis].acceleration,
        .jerk = settings->scurve ? jerk : 0.0f,
    };
    if (!jog_active() && request.target == stepper_position_steps(axis)) {
        return ERR_OK; // it stands there: a step too short, or at its limit
    }
    hal_governor_lock();
    jog_start(&request);
    hal_governor_request();
    hal_governor_unlock();
    return ERR_OK;
}

err_t stepper_jog_stop(void) {
    err_t err = rules_check(RULES_DO_STOP);
    if (err == ERR_OK) {
        hal_governor_lock();
        jog_stop();
        hal_governor_unlock();
    }
    return err;
}
