// The 100 kHz tick and the governor's turn, as plain calls at their virtual times.
#ifndef HOST_TICK_H
#define HOST_TICK_H

#include <stdbool.h>
#include <stdint.h>

// Time of the next tick; HOST_CLOCK_NEVER while it is stopped. Context: any.
uint64_t host_tick_next_ns(void);

// Carries out the ticks up to and including `until_ns`, each followed by the governor if it was
// asked for. Returns true, with `stop_on_news` at once, if the governor ran or the tick stopped.
// Context: main.
bool host_tick_run(uint64_t until_ns, bool stop_on_news);

typedef enum {
    HOST_TICK_MAIN,
    HOST_TICK_LOCKED, // the main loop, with the governor held off
    HOST_TICK_GOVERNOR,
    HOST_TICK_TICK
} host_tick_context_t;

// Whose code is running. Context: any.
host_tick_context_t host_tick_context(void);

// What happens to code into which a tick comes, for tests of races: the next tick is carried out
// now, time jumps there, and behind it the governor has its turn if it was asked for, unless it is
// locked or is the code that was interrupted. No effect in the tick itself and while the tick is
// stopped. Input events are not looked at. Context: any.
void host_tick_interrupt(void);

#endif
