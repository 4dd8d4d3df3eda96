// Interrupts of a BASIC program. Context: main loop.
#include "events.h"

#include <string.h>

#include "calls.h"
#include "console.h"
#include "errors.h"
#include "hal/hal.h"
#include "symbols.h"
#include "vm.h"

#define NO_KEY (-1)
#define MEMORY_NEEDED (2u * ERR_MESSAGE_SIZE) // bytes free before a SUB is entered

typedef struct {
    uint64_t due_us;    // while it is held: what is left
    uint64_t period_us; // 0: off
    bool held;
} tick_t;

static struct {
    basic_routine_t routines[BASIC_EVENTS];
    uint32_t raised; // bit n: event n
    unsigned last;   // the event served last
    tick_t ticks[EVENTS_TICKS];
    // What the program gets back when the SUB under way ends.
    err_t error_code;
    const char *error_text; // NULL: empty
    vm_on_error_t on_error;
    unsigned skip_count;
} events;

uint32_t events_watch;

static uint32_t bit(unsigned event) {
    return 1u << event;
}

// While a SUB is under way nothing is looked for, and ticks are not even counted.
static void update_watch(void) {
    uint32_t watch = events.raised;
    for (unsigned i = 0; i < EVENTS_TICKS; i++) {
        if (events.ticks[i].period_us != 0 && !events.ticks[i].held) {
            watch |= bit(BASIC_EVENT_TICK1 + i);
        }
    }
    if (events.routines[BASIC_EVENT_KEY] != 0) {
        watch |= bit(BASIC_EVENT_KEY);
    }
    events_watch = vm.interrupt_depth != 0 ? 0 : watch;
}

void events_clear(void) {
    memset(&events, 0, sizeof events);
    console_set_hot_key(NO_KEY, NULL);
    vm.interrupt_depth = 0;
    update_watch();
}

err_t basic_find_routine(basic_text_t name, basic_routine_t *routine) {
    const symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, name.text, name.length);
    if (symbol == NULL || symbol->routine->is_function) {
        return err_raise(ERR_NO_USER_SUB, "%s", "");
    }
    if (symbol->routine->parameters != 0) {
        return err_raise(ERR_HAS_PARAMETERS, "%s", symbol->name);
    }
    *routine = memory_handle(symbol);
    return ERR_OK;
}

basic_routine_t events_routine(const char *name, size_t length) {
    basic_routine_t routine = 0;
    if (basic_find_routine((basic_text_t){name, length}, &routine) != ERR_OK) {
        errors_fail_raised();
    }
    return routine;
}

// ---- Setting and raising ------------------------------------------------------------------------

void basic_set_event(unsigned event, basic_routine_t routine) {
    events.routines[event] = routine;
    if (routine == 0) {
        events.raised &= ~bit(event);
    }
    update_watch();
}

void basic_raise_event(unsigned event) {
    if (events.routines[event] != 0) {
        events.raised |= bit(event);
        update_watch();
        console_wake();
    }
}

void events_set_tick(unsigned tick, uint64_t period_us, basic_routine_t routine) {
    bool on = period_us != 0 && routine != 0;
    events.ticks[tick] = (tick_t){.period_us = on ? period_us : 0};
    events.ticks[tick].due_us = hal_time_us() + period_us;
    events.raised &= ~bit(BASIC_EVENT_TICK1 + tick);
    basic_set_event(BASIC_EVENT_TICK1 + tick, on ? routine : 0);
}

void events_hold_tick(unsigned tick, bool hold) {
    tick_t *timer = &events.ticks[tick];
    if (timer->period_us == 0 || timer->held == hold) {
        return;
    }
    uint64_t now = hal_time_us();
    if (hold) {
        timer->due_us = timer->due_us > now ? timer->due_us - now : 0;
    } else {
        timer->due_us += now;
    }
    timer->held = hold;
    update_watch();
}

static void key_pressed(void) {
    basic_raise_event(BASIC_EVENT_KEY_CODE);
}

void events_set_key_code(int code, basic_routine_t routine) {
    bool on = code != NO_KEY && routine != 0;
    console_set_hot_key(on ? code : NO_KEY, key_pressed);
    basic_set_event(BASIC_EVENT_KEY_CODE, on ? routine : 0);
}

// ---- Looking ------------------------------------------------------------------------------------

static void look_at_tick(unsigned tick, uint64_t now) {
    tick_t *timer = &events.ticks[tick];
    if (timer->period_us == 0 || timer->held || now < timer->due_us) {
        return;
    }
    events.raised |= bit(BASIC_EVENT_TICK1 + tick);
    timer->due_us += timer->period_us;
    if (timer->due_us <= now) { // missed ticks are not made up for, but the beat is kept
        timer->due_us += (now - timer->due_us) / timer->period_us * timer->period_us;
        timer->due_us += timer->period_us;
    }
}

static void look(void) {
    const uint32_t ticks = (bit(EVENTS_TICKS) - 1u) << BASIC_EVENT_TICK1;
    if (events_watch & ticks) {
        uint64_t now = hal_time_us();
        for (unsigned i = 0; i < EVENTS_TICKS; i++) {
            look_at_tick(i, now);
        }
    }
    if (events.routines[BASIC_EVENT_KEY] != 0 && console_input_waits()) {
        events.raised |= bit(BASIC_EVENT_KEY);
    }
}

uint64_t events_next_us(uint64_t until_us) {
    for (unsigned i = 0; i < EVENTS_TICKS && events_watch != 0; i++) {
        const tick_t *timer = &events.ticks[i];
        if (timer->period_us != 0 && !timer->held && timer->due_us < until_us) {
            until_us = timer->due_us;
        }
    }
    return until_us;
}

// ---- Serving ------------------------------------------------------------------------------------

// A program that is as deep as it may be is not ended by an event: the event waits until there is
// room.
static bool has_room(const symbols_routine_t *routine) {
    return calls_have_room(routine) && memory_free() > MEMORY_NEEDED;
}

// Errors, and what ON ERROR says about them, are the SUB's own; ON ERROR IGNORE holds for it too.
static void save_error_state(void) {
    events.on_error = vm.on_error;
    events.skip_count = vm.skip_count;
    events.error_code = vm.error_code;
    events.error_text = NULL;
    if (vm.error_text[0] != '\0') {
        size_t size = strlen(vm.error_text) + 1;
        events.error_text = memcpy(memory_text(size), vm.error_text, size);
        vm.error_text[0] = '\0';
        vm.scratch_base = memory.scratch;
    }
    if (vm.on_error == VM_ERROR_SKIP) {
        vm.on_error = VM_ERROR_ABORT;
    }
}

static void enter(const symbols_routine_t *routine) {
    (vm.sp++)->type = VALUE_NONE; // the place for a FUNCTION's value
    calls_enter(routine, 0);
    vm.interrupt_depth = vm.depth;
    save_error_state();
    update_watch();
}

// In turn, so that an event whose SUB takes too long does not shut the others out.
static unsigned next_event(void) {
    uint32_t behind = events.raised & ~(bit(events.last) | (bit(events.last) - 1u));
    return (unsigned)__builtin_ctz(behind != 0 ? behind : events.raised);
}

bool events_serve(void) {
    look();
    if (events.raised == 0) {
        return false;
    }
    unsigned event = next_event();
    const symbols_t *symbol = memory_place(events.routines[event]);
    if (!has_room(symbol->routine)) {
        return false;
    }
    events.raised &= ~bit(event);
    events.last = event;
    enter(symbol->routine);
    return true;
}

void events_left(void) {
    vm.on_error = events.on_error;
    vm.skip_count = events.skip_count;
    vm.error_code = events.error_code;
    if (events.error_text != NULL) {
        strcpy(vm.error_text, events.error_text);
    } else {
        vm.error_text[0] = '\0';
    }
    vm.interrupt_depth = 0;
    update_watch();
}
