// Whether a stored program is started at power-up. Context: main loop.
#include "boot.h"

#include "console.h"
#include "hal/hal.h"
#include "options.h"

#define CTRL_C 3
#define RESCUE_US 5000000u // time for a terminal to be connected again

// What is typed ahead stays input, but for Ctrl-C.
static bool is_cancelled(void) {
    int key = console_take();
    if (key >= 0 && key != CTRL_C) {
        console_untake(key);
    }
    return key == CTRL_C;
}

bool boot_is_wanted(void) {
    hal_start_t reason = hal_start_reason();
    if (reason == HAL_START_FAULT || reason == HAL_START_HUNG) {
        return false;
    }
    uint64_t until_us = hal_time_us();
    if (options_get(OPTIONS_BREAK) != CTRL_C) {
        console_print("Ctrl-C now keeps the program from starting\r\n");
        until_us += RESCUE_US;
    }
    bool cancelled = is_cancelled();
    while (!cancelled && !console_has_input() && hal_time_us() < until_us) {
        console_wait(until_us);
        cancelled = is_cancelled();
    }
    return !cancelled;
}
