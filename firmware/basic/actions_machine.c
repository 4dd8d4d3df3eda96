// CPU, WATCHDOG, TRACE and LIST PINS at run time. Context: main loop.
#include <string.h>

#include "actions.h"
#include "channels.h"
#include "console.h"
#include "errors.h"
#include "hal/hal.h"
#include "hal/pins.h"
#include "pager.h"
#include "trace.h"
#include "watchdog.h"

#define WATCHDOG_MAX_MS 2147483647
#define LAST_WORDS_US 20000u // for the terminal to fetch what has been printed

static err_t (*may_restart)(void);

void actions_start(const basic_config_t *config) {
    may_restart = config->may_restart;
}

// Files are closed and what was printed has gone out before it happens.
static void prepare_restart(void) {
    if (may_restart != NULL && may_restart() != ERR_OK) {
        errors_fail_raised();
    }
    channels_end_program();
    console_flush();
    for (uint64_t until_us = hal_time_us() + LAST_WORDS_US; hal_time_us() < until_us;) {
        hal_idle(until_us);
    }
}

void actions_restart(value_t *arguments, unsigned count) {
    (void)count;
    prepare_restart();
    if (arguments->integer != 0) {
        hal_bootloader();
    }
    hal_restart(false);
}

void actions_watchdog(value_t *arguments, unsigned count) {
    (void)count;
    int64_t milliseconds = value_to_integer(arguments);
    if (milliseconds < 0 || milliseconds > WATCHDOG_MAX_MS) {
        errors_fail_with(ERR_ARGUMENT, "timeout: %ld is invalid (valid is 1 to %ld milliseconds)",
                         (long)milliseconds, (long)WATCHDOG_MAX_MS);
    }
    watchdog_set((uint32_t)milliseconds);
}

void actions_trace(value_t *arguments, unsigned count) {
    (void)count;
    trace_show(arguments->integer != 0);
}

void actions_trace_list(value_t *arguments, unsigned count) {
    (void)count;
    int64_t lines = value_to_integer(arguments);
    if (lines < 1) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    trace_list(lines < TRACE_LINES ? (unsigned)lines : TRACE_LINES);
}

// Who uses which pin.
void actions_list_pins(value_t *arguments, unsigned count) {
    (void)count;
    pager_start(value_is_true(arguments));
    bool more = true;
    for (unsigned gpio = 0; gpio < PINS_COUNT && more; gpio++) {
        const char *owner = pins_owner(gpio);
        if (pins_is_user(gpio)) {
            char text[64];
            format_text(text, sizeof text, "%-14s %s", pins_name(gpio),
                        owner != NULL ? owner : "Unused");
            more = pager_line(text, strlen(text));
        }
    }
}
