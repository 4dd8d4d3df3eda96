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

#endif
