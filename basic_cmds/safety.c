// HWLIMITS, RECOVER, and what happens without being asked for: messages, ON STEPPER EVENT,
// PEEK(STEPPER EVENT). Context: main loop.
#include "basic_cmds/safety.h"

#include <string.h>

#include "basic_cmds/events.h"
#include "basic_cmds/machine_outputs.h"
#include "basic_cmds/report.h"
#include "gcode/gcode.h"
#include "stepper/stepper_safety.h"

// ---- Limit switches -----------------------------------------------------------------------------

// The minimum pins of X, Y and Z come first, then the maximum pins; so do the bits of the mask.
static unsigned switch_of(unsigned place) {
    return 2 * (place % 3) + place / 3;
}

err_t safety_hwlimits(const basic_arg_t *args, size_t count) {
    (void)count;
    stepper_hwlimits_t config = {.active_high = 0};
    for (unsigned place = 0; place < STEPPER_SWITCHES; place++) {
        unsigned which = switch_of(place);
        config.gpio[which] = (uint8_t)args[place].integer;
        config.active_high |= (uint32_t)((args[HWLIMITS_INVERT].integer >> place) & 1) << which;
    }
    err_t err = stepper_hwlimits(&config);
    if (err == ERR_OK) {
        basic_printf("Hardware limit switches configured\n");
        safety_warn();
    }
    return err;
}

err_t safety_filter(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_filter((uint32_t)args[0].integer, (uint32_t)args[1].integer);
}

err_t safety_keep(const basic_arg_t *args, size_t count) {
    (void)count;
    return stepper_limit_keep(args[0].integer != 0);
}

void safety_warn(void) {
    uint32_t overridden = stepper_overridden();
    if (overridden != 0) {
        char names[STEPPER_SWITCH_NAMES_SIZE];
        basic_printf("Warning: limit switch %s is active - home (G28) or jog off it\n",
                     stepper_switch_names(names, overridden));
    }
}

err_t safety_recover(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    err_t err = stepper_recover();
    if (err == ERR_OK) {
        gcode_reset_modal();
        basic_printf("Stepper recovered - disarmed, buffer cleared\n");
    }
    return err;
}

static void print_switches(const stepper_hwlimits_t *switches) {
    uint32_t pressed = stepper_pressed();
    bool any = false;
    basic_printf("Limit switches:");
    for (unsigned n = 0; n < STEPPER_SWITCHES; n++) {
        if (switches->gpio[n] != PINS_NONE) {
            basic_printf("%s %s %s%s%s", any ? "," : "", stepper_switch_name((stepper_switch_t)n),
                         pins_name(switches->gpio[n]),
                         (switches->active_high >> n) & 1 ? " active high" : "",
                         (pressed >> n) & 1 ? " ACTIVE" : "");
            any = true;
        }
    }
    basic_printf("%s\n", any ? "" : " none");
}

void safety_print_status(void) {
    static const char *const alarms[] = {"none", "LIMIT", "E-STOP"};
    stepper_safety_t safety;
    stepper_safety(&safety);
    basic_printf("Alarm: %s\n", alarms[stepper_alarm()]);
    print_switches(&safety.switches);
    basic_printf("Filter: limits %u, E-STOP %u samples of 10 us; drivers stay on behind a limit: "
                 "%s\n",
                 (unsigned)safety.limit_samples, (unsigned)safety.estop_samples,
                 safety.keep_enabled ? "YES" : "NO");
}

// ---- Messages -----------------------------------------------------------------------------------

static void tell_trip(void) {
    stepper_trip_t trip;
    stepper_last_trip(&trip);
    const char *lost = trip.position_lost ? ", position unknown" : "";
    if (trip.estop) {
        basic_notice("Hardware E-STOP trip - emergency stop%s", lost);
    } else {
        char names[STEPPER_SWITCH_NAMES_SIZE];
        basic_notice("Limit switch trip: %s - motion stopped%s",
                     stepper_switch_names(names, trip.switches), lost);
    }
    basic_notice("%s, then STEPPER RUN", trip.estop ? "Clear E-STOP, home (G28) or STEPPER RECOVER"
                                                    : "Home (G28), or STEPPER RECOVER");
}

// ---- Events of a program ------------------------------------------------------------------------

// The kinds that the program has not taken, the oldest first, each once.
static struct {
    uint8_t kinds[STEPPER_EVENTS];
    uint8_t count;
    uint8_t also; // TAKEN, IDLE
} waiting;

enum {
    TAKEN = 1, // the program took one, so the SUB is called again for those that are left
    IDLE = 2   // the queue is empty, but a file or a line of G-code will go on
};

static void hand_on(stepper_event_t event) {
    if (memchr(waiting.kinds, (int)event, waiting.count) == NULL) {
        waiting.kinds[waiting.count++] = (uint8_t)event;
    }
    basic_raise_event(EVENTS_STEPPER);
}

static void take(stepper_event_t event) {
    switch (event) {
    case STEPPER_EVENT_ESTOP:
    case STEPPER_EVENT_LIMIT:
        tell_trip();
        break;
    case STEPPER_EVENT_PAUSED:
        machine_outputs_tell_pause();
        break;
    case STEPPER_EVENT_IDLE:
        waiting.also |= IDLE;
        return;
    default:
        break;
    }
    hand_on(event);
}

// Apart, so that there is little to do as a rule: a program asks every few statements.
static void __attribute__((noinline)) take_all(stepper_event_t event) {
    for (; event != STEPPER_EVENT_NONE; event = stepper_next_event()) {
        take(event);
    }
    if ((waiting.also & IDLE) != 0 && report_active() <= 0) {
        waiting.also &= (uint8_t)~IDLE;
        hand_on(STEPPER_EVENT_IDLE);
    }
    if ((waiting.also & TAKEN) != 0 && waiting.count > 0) {
        basic_raise_event(EVENTS_STEPPER);
    }
    waiting.also &= (uint8_t)~TAKEN;
}

void safety_background(void) {
    stepper_event_t event = stepper_next_event();
    if (((unsigned)event | waiting.also) != 0) { // NONE is 0
        take_all(event);
    }
}

void safety_clear(void) {
    memset(&waiting, 0, sizeof waiting);
}

err_t safety_on_event(const basic_arg_t *args, size_t count) {
    (void)count;
    basic_set_event(EVENTS_STEPPER, (basic_routine_t)args[0].integer);
    return ERR_OK;
}

err_t safety_peek_event(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    safety_background(); // what has just happened is known at once
    *result = (basic_value_t){.type = BASIC_INTEGER, .integer = STEPPER_EVENT_NONE};
    if (waiting.count > 0) {
        result->integer = waiting.kinds[0];
        waiting.count--;
        memmove(waiting.kinds, waiting.kinds + 1, waiting.count);
        waiting.also |= TAKEN;
    }
    return ERR_OK;
}
