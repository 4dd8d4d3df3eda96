// Arming, stopping, and where the machine stands. Context: main loop.
#include "stepper/alarm.h"
#include "stepper/axis.h"
#include "stepper/cycle.h"
#include "stepper/governor.h"
#include "stepper/limits.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/planner.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"

// Planning more blocks than this anew holds the governor off for longer than it is ahead; for a
// full queue it takes less than this.
#define REPLAN_BLOCKS 100u
#define REPLAN_TICKS 300u

// What is queued would begin at once, with a switch that does not trip any more.
static err_t check_switches(void) {
    uint32_t pressed = governor_armed() ? 0 : stepper_pressed();
    if (pressed == 0 || ring_used(&blocks.ring) == 0) {
        return ERR_OK;
    }
    char names[STEPPER_SWITCH_NAMES_SIZE];
    return err_raise(ERR_LIMIT_BEFORE_RUN, "%s", stepper_switch_names(names, pressed));
}

err_t stepper_run(stepper_idle_t idle) {
    err_t err = rules_check(RULES_DO_RUN);
    if (err == ERR_OK) {
        err = check_switches();
    }
    if (err == ERR_OK) {
        machine.idle = idle;
        machine_arm(machine.idle);
    }
    return err;
}

static void drop_queue(void) {
    hal_governor_lock();
    planner_reset(machine.config.blocks);
    hal_governor_unlock();
    machine_follow_motors();
    alarm_count_drop();
}

err_t stepper_clear(void) {
    err_t err = rules_check(RULES_DO_CLEAR);
    if (err == ERR_OK) {
        drop_queue();
    }
    return err;
}

void stepper_stop(void) {
    if (!machine.initialized) {
        return;
    }
    cycle_stop();
    if (!governor_working()) {
        stepper_hold(false);
        drop_queue();
        return;
    }
    alarm_count_drop();
    hal_governor_lock();
    governor_stop();
    hal_governor_request();
    hal_governor_unlock();
}

err_t stepper_hold(bool hold) {
    err_t err = rules_check(RULES_DO_STOP);
    if (err == ERR_OK) {
        hal_governor_lock();
        governor_hold(hold);
        hal_governor_request();
        hal_governor_unlock();
    }
    return err;
}

void machine_pass_override_on(void) {
    planner_override_t override = {.feed = 1.0f, .rapid = 1.0f};
    if (!cycle_moves()) {
        override.feed = (float)machine.feed_override / 100.0f;
        override.rapid = (float)machine.rapid_override / 100.0f;
    }
    if (ring_used(&blocks.ring) > REPLAN_BLOCKS) {
        hal_governor_lock();
        governor_fill(REPLAN_TICKS);
        hal_governor_unlock();
    }
    planner_set_override(&override);
}

err_t stepper_override(int feed_percent, int rapid_percent) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        machine.feed_override = feed_percent;
        machine.rapid_override = rapid_percent;
        machine_pass_override_on();
    }
    return err;
}

err_t stepper_estop(void) {
    err_t err = rules_check(RULES_DO_STOP);
    if (err != ERR_OK) {
        return err;
    }
    hal_governor_lock();
    bool moved = governor_emergency_stop(machine.config.estop_keeps_enabled);
    hal_governor_unlock();
    if (moved) {
        machine_lose_position(MACHINE_ALL_AXES);
    }
    alarm_count_drop();
    machine_follow_stops();
    return ERR_OK;
}

// ---- Position -----------------------------------------------------------------------------------

err_t stepper_set_home(void) {
    err_t err = rules_check(RULES_DO_PLACE);
    if (err == ERR_OK) {
        err = alarm_acknowledge();
    }
    if (err == ERR_OK) {
        machine_stand_at((const int32_t[AXIS_COUNT]){0});
    }
    return err;
}

err_t stepper_set_position(axis_id_t axis, double position) {
    err_t err = rules_check(RULES_DO_PLACE);
    if (err == ERR_OK) {
        err = stepper_check_axis(axis);
    }
    if (err != ERR_OK) {
        return err;
    }
    int32_t steps[AXIS_COUNT];
    machine_motor_steps(steps);
    if (!axis_to_steps(axis, position, &steps[axis])) {
        return err_raise(ERR_AXIS_TOO_FAR, "%c", STEPPER_AXIS_LETTERS[axis]);
    }
    err = alarm_acknowledge();
    if (err == ERR_OK) {
        machine_stand_at(steps);
    }
    return err;
}

int32_t stepper_position_steps(axis_id_t axis) {
    int32_t steps[AXIS_COUNT];
    machine_motor_steps(steps);
    return steps[axis];
}

double stepper_position(axis_id_t axis) {
    return axis_from_steps(axis, stepper_position_steps(axis));
}
