// SETTICK and ON KEY at run time. Context: main loop.
#include "actions.h"
#include "args.h"
#include "errors.h"
#include "events.h"

#define PERIOD_MIN_MS 0.1
#define PERIOD_MAX_MS 2147483647.0 // MMBasic's: 24 days

static unsigned tick_of(const value_t *value) {
    int64_t number = value_to_integer(value);
    if (number < 1 || number > EVENTS_TICKS) {
        errors_fail_with(ERR_ARGUMENT, "number: %ld is invalid (valid is 1 to %d)", (long)number,
                         EVENTS_TICKS);
    }
    return (unsigned)number - 1;
}

void actions_settick(value_t *arguments, unsigned count) {
    (void)count;
    double period_ms = value_to_number(&arguments[0]);
    basic_routine_t routine = args_routine("sub", &arguments[1]);
    unsigned tick = tick_of(&arguments[2]);
    bool on = period_ms != 0.0;
    if (on && !(period_ms >= PERIOD_MIN_MS && period_ms <= PERIOD_MAX_MS)) {
        errors_fail_with(ERR_ARGUMENT,
                         "period: %g is invalid (valid is 0, 0.1 to 2147483647 milliseconds)",
                         period_ms);
    }
    events_set_tick(tick, on ? (uint64_t)(period_ms * 1000.0 + 0.5) : 0, routine);
}

void actions_settick_hold(value_t *arguments, unsigned count) {
    (void)count;
    args_routine("sub", &arguments[1]);
    events_hold_tick(tick_of(&arguments[2]), arguments[0].integer != 0);
}

void actions_on_key(value_t *arguments, unsigned count) {
    (void)count;
    basic_set_event(BASIC_EVENT_KEY, args_routine("sub", arguments));
}

void actions_on_key_code(value_t *arguments, unsigned count) {
    (void)count;
    int64_t code = value_to_integer(&arguments[0]);
    if (code < 1 || code > UINT8_MAX) {
        errors_fail_with(ERR_ARGUMENT, "code: %ld is invalid (valid is 1 to 255)", (long)code);
    }
    events_set_key_code((int)code, args_routine("sub", &arguments[1]));
}
