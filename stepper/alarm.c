// What the safety inputs have done, until it is acknowledged and told; and the other events.
// Context: main loop.
#include "stepper/alarm.h"

#include <string.h>

#include "stepper/governor.h"
#include "stepper/limits.h"
#include "stepper/machine.h"
#include "stepper/outputs.h"
#include "stepper/rules.h"
#include "stepper/stepper_homing.h"

#define LOOK (1u << 15) // among the events: something has to be followed though nothing happened

static struct {
    stepper_alarm_t alarm;
    stepper_trip_t trip; // the last one
    uint16_t events;     // bit of each that was not taken
    uint32_t drops;
    uint32_t ends_seen;   // of the motions, for STEPPER_EVENT_IDLE
    uint32_t pauses_seen; // for STEPPER_EVENT_PAUSED
} state;

void alarm_reset(void) {
    uint32_t drops = state.drops + 1;
    memset(&state, 0, sizeof state);
    state.drops = drops;
    machine.alarm = false;
    state.ends_seen = governor_ends();
    state.pauses_seen = governor_pauses();
}

// Once, and at once: telling the user may take its time, and a position set until then stays known.
static void follow_trip(void) {
    hal_governor_lock();
    governor_trip_t trip = governor_take_trip();
    hal_governor_unlock();
    state.trip.switches = limits_switches(trip.pins);
    state.trip.estop = (trip.pins & pins_mask(machine.config.estop_gpio)) != 0;
    state.trip.position_lost = machine.position_known && trip.moved;
    if (trip.moved) {
        machine_lose_position(MACHINE_ALL_AXES);
    }
    if (state.trip.estop) {
        state.alarm = STEPPER_ALARM_ESTOP;
        stepper_raise_event(STEPPER_EVENT_ESTOP);
    } else {
        state.alarm = state.alarm == STEPPER_ALARM_NONE ? STEPPER_ALARM_LIMIT : state.alarm;
        stepper_raise_event(STEPPER_EVENT_LIMIT);
    }
    machine.alarm = true;
    state.ends_seen = governor_ends();
    alarm_count_drop();
}

void alarm_follow(void) {
    if (governor_tripped()) {
        follow_trip();
    }
    limits_follow();
}

// ---- The alarm ----------------------------------------------------------------------------------

const char *alarm_names(char names[ALARM_NAMES_SIZE]) {
    if (state.alarm == STEPPER_ALARM_ESTOP) {
        return "E-STOP";
    }
    char switches[STEPPER_SWITCH_NAMES_SIZE];
    format_text(names, ALARM_NAMES_SIZE, "Limit switch %s",
                stepper_switch_names(switches, state.trip.switches));
    return names;
}

err_t alarm_acknowledge(void) {
    if (machine_estop_asserted()) {
        return err_raise(ERR_ESTOP_ACTIVE, NULL);
    }
    state.alarm = STEPPER_ALARM_NONE;
    machine.alarm = false;
    return ERR_OK;
}

stepper_alarm_t stepper_alarm(void) {
    alarm_follow();
    return state.alarm;
}

void stepper_last_trip(stepper_trip_t *trip) {
    *trip = state.trip;
}

err_t stepper_recover(void) {
    err_t err = rules_check(RULES_DO_RECOVER);
    if (err != ERR_OK) {
        return err;
    }
    machine_stop_and_wait();
    hal_governor_lock();
    bool moved = governor_emergency_stop(true);
    hal_governor_unlock();
    if (moved) {
        machine_lose_position(MACHINE_ALL_AXES);
    }
    machine_follow_stops();
    alarm_count_drop();
    return alarm_acknowledge();
}

// ---- Events -------------------------------------------------------------------------------------

void stepper_raise_event(stepper_event_t event) {
    state.events = (uint16_t)(state.events | 1u << event);
}

// Apart, so that there is little to do as a rule: a program asks every few statements.
static stepper_event_t __attribute__((noinline)) look_for_event(void) {
    alarm_follow();
    bool idle = !governor_working() && stepper_cycle() == STEPPER_CYCLE_NONE;
    if (idle && governor_ends() != state.ends_seen) {
        state.ends_seen = governor_ends();
        stepper_raise_event(STEPPER_EVENT_IDLE);
    }
    if (governor_paused() && governor_pauses() != state.pauses_seen) {
        state.pauses_seen = governor_pauses();
        stepper_raise_event(STEPPER_EVENT_PAUSED);
    }
    uint32_t events = state.events & ~LOOK;
    if (!machine.limit_active) {
        state.events = (uint16_t)events;
    }
    if (events == 0) {
        return STEPPER_EVENT_NONE;
    }
    stepper_event_t event = (stepper_event_t)__builtin_ctz(events);
    state.events = (uint16_t)(state.events & ~(1u << event));
    return event;
}

stepper_event_t stepper_next_event(void) {
    bool news = state.events != 0 || governor_ends() != state.ends_seen;
    return news ? look_for_event() : STEPPER_EVENT_NONE;
}

void alarm_look(void) {
    state.events |= LOOK;
}

void alarm_count_drop(void) {
    outputs_forget_beam();
    state.drops++;
}

uint32_t stepper_drops(void) {
    alarm_follow();
    return state.drops;
}
