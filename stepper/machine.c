// The machine's state and what it forbids. Context: main loop.
#include "stepper/machine.h"

#include "stepper/alarm.h"
#include "stepper/cycle.h"
#include "stepper/governor.h"
#include "stepper/jog.h"
#include "stepper/limits.h"
#include "stepper/moves.h"
#include "stepper/outputs.h"
#include "stepper/planner.h"
#include "stepper/step_isr.h"

#define ENDING_US 5000u // the governor is at most half of it ahead

machine_t machine = {.config = {.estop_gpio = PINS_NONE}};

void machine_motor_steps(int32_t steps[AXIS_COUNT]) {
    hal_governor_lock();
    governor_position(steps);
    hal_governor_unlock();
}

void machine_follow_motors(void) {
    int32_t steps[AXIS_COUNT];
    machine_motor_steps(steps);
    moves_set_position(steps);
    outputs_follow();
}

void machine_follow_stops(void) {
    if (!machine.initialized) {
        return;
    }
    alarm_follow();
    uint32_t drops = governor_drops();
    if (drops != machine.drops_seen && !governor_working()) {
        machine.drops_seen = drops;
        machine_follow_motors();
    }
    cycle_follow();
}

bool machine_stopping(void) {
    return governor_stopping() || governor_drops() != machine.drops_seen;
}

void machine_arm(stepper_idle_t idle) {
    if (!governor_armed()) {
        limits_override_pressed();
    }
    hal_governor_lock();
    governor_arm(idle == STEPPER_IDLE_DISABLE);
    hal_governor_request();
    hal_governor_unlock();
}

bool machine_executing(void) {
    return governor_working() || (hal_tick_running() && !step_isr_watches());
}

// Nothing is queued any more: what the tick still executes, such as the time that drivers need when
// they are turned on, ends within milliseconds.
static bool is_ending(void) {
    return machine_executing() && ring_used(&blocks.ring) == 0 && !jog_active();
}

void machine_await_end(void) {
    uint64_t limit_us = hal_time_us() + ENDING_US;
    while (is_ending() && hal_time_us() < limit_us) {
        hal_idle(limit_us);
    }
}

bool machine_estop_asserted(void) {
    uint32_t mask = pins_mask(machine.config.estop_gpio);
    return mask != 0 && (hal_pins_read() & mask) == 0;
}

void machine_stand_at(const int32_t steps[AXIS_COUNT]) {
    hal_governor_lock();
    governor_set_position(steps);
    hal_governor_unlock();
    moves_set_position(steps);
    machine.known_axes = MACHINE_ALL_AXES;
    machine.position_known = true;
}

void machine_lose_position(uint32_t lost) {
    machine.known_axes = (uint8_t)(machine.known_axes & ~lost);
    machine.position_known = false;
}

void machine_stop_and_wait(void) {
    stepper_stop();
    while (governor_working()) {
        hal_idle(hal_time_us() + 1000);
    }
}
