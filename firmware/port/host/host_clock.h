// The virtual clock: a plain number that only this part moves. Nothing happens at the simulated
// pins between two events, so time jumps from one to the next. Context: any.
#ifndef HOST_CLOCK_H
#define HOST_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#define HOST_CLOCK_NEVER UINT64_MAX

// Nanoseconds since start.
uint64_t host_clock_now_ns(void);

// Moves the clock to an event that is about to happen. Not backwards.
void host_clock_set_ns(uint64_t now_ns);

// Time of the next tick, input event, received byte, bit of a wire or alarm; HOST_CLOCK_NEVER if
// nothing is to come.
uint64_t host_clock_next_event_ns(void);

// Lets time pass up to and including `until_ns`, with all ticks, governor calls and input events
// that fall into it, in order of time; an input edge comes before a tick of the same time. With
// `stop_on_news` it returns early when the main loop may have something to see: the governor ran,
// the tick stopped, an input changed. Returns true if there was such news. Context: main.
bool host_clock_run(uint64_t until_ns, bool stop_on_news);

#endif
