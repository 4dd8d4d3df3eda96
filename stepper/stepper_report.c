// What may be asked of the machine. Context: main loop.
#include "stepper/axis.h"
#include "stepper/geometry.h"
#include "stepper/governor.h"
#include "stepper/jog.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/step_isr.h"
#include "stepper/stepper_homing.h"
#include "stepper/stepper_safety.h"

void stepper_status(stepper_status_t *status) {
    machine_follow_stops();
    *status = (stepper_status_t){
        .initialized = machine.initialized,
        .armed = governor_armed(),
        .moving = stepper_active() > 0,
        .stopping = machine_stopping(),
        .holding = governor_holding(),
        .jogging = jog_active(),
        .position_known = machine.position_known,
        .idle = machine.idle,
        .blocks = machine.config.blocks,
        .blocks_free = stepper_blocks_free(),
        .executed = governor_executed(),
        .underruns = step_isr_dry_count(),
        .feed_override = machine.feed_override,
        .rapid_override = machine.rapid_override,
        .junction_deviation_mm = (double)geometry_settings.deviation,
        .arc_tolerance_mm = machine.config.arc_tolerance_mm,
        .estop_gpio = machine.config.estop_gpio,
        .estop_keeps_enabled = machine.config.estop_keeps_enabled,
        .scurve = geometry_settings.scurve,
        .jerk = (double)geometry_settings.jerk,
    };
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        status->axis_jerk[axis] = (double)geometry_settings.axis_jerk[axis];
    }
}

bool stepper_axis_configured(axis_id_t axis) {
    return axes[axis].configured;
}

bool stepper_axis_config(axis_id_t axis, stepper_axis_t *config) {
    *config = axes[axis].config;
    return axes[axis].configured;
}

bool stepper_axis_limits(axis_id_t axis, double *min_mm, double *max_mm) {
    *min_mm = axes[axis].min;
    *max_mm = axes[axis].max;
    return axes[axis].limited;
}

double stepper_speed(void) {
    return (double)(jog_active() ? jog_speed() : governor_speed()) * 60.0;
}

int stepper_active(void) {
    if (!machine.initialized) {
        return -1;
    }
    return governor_working() || stepper_cycle() != STEPPER_CYCLE_NONE ? 1 : 0;
}

uint32_t stepper_blocks_free(void) {
    return machine.initialized ? moves_free() : 0;
}

uint32_t stepper_status_bits(void) {
    machine_follow_stops();
    uint32_t bits = stepper_pressed(); // bits 0 to 5
    bits |= machine_estop_asserted() ? STEPPER_STATUS_ESTOP : 0;
    bits |= machine.initialized && machine.position_known ? STEPPER_STATUS_POSITION_KNOWN : 0;
    return bits;
}
