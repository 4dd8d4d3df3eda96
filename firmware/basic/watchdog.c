// The watchdog of programs. Context: main loop.
#include "watchdog.h"

#include "hal/hal.h"

static uint64_t bites_us; // 0: off

void watchdog_set(uint32_t milliseconds) {
    bites_us = milliseconds != 0 ? hal_time_us() + milliseconds * 1000ull : 0;
}

void watchdog_look(void) {
    if (bites_us != 0 && hal_time_us() >= bites_us) {
        hal_restart(true);
    }
}

uint64_t watchdog_next_us(uint64_t until_us) {
    return bites_us != 0 && bites_us < until_us ? bites_us : until_us;
}
