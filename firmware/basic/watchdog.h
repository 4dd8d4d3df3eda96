// WATCHDOG: restarts the board if a program does not say in time that it is well. It does not
// replace the board's own, which restarts it when the firmware hangs. Context: main loop.
#ifndef BASIC_WATCHDOG_H
#define BASIC_WATCHDOG_H

#include <stdint.h>

// Restarts in so many milliseconds unless called again; 0: off.
void watchdog_set(uint32_t milliseconds);

// Restarts if it is time. To be called every few statements, and while something waits.
void watchdog_look(void);

// When that is, at most `until_us`: nothing may sleep longer.
uint64_t watchdog_next_us(uint64_t until_us);

#endif
