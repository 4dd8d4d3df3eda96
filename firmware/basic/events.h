// Interrupts of a BASIC program: events, and the SUBs they call. An event is looked for at the
// start of each statement and while PAUSE waits; its SUB is called there, one at a time, and the
// statement goes on behind it. Context: main loop.
#ifndef BASIC_EVENTS_H
#define BASIC_EVENTS_H

#include <stdbool.h>
#include <stdint.h>

#include "basic/basic.h"

#define EVENTS_TICKS 4

// Not 0: events_serve() may have something to do. The one word a statement without events costs.
extern uint32_t events_watch;

// Forgets all routines, ticks and whatever has been raised.
void events_clear(void);

// The SUB `name`, which must have no parameters. Error: there is none.
basic_routine_t events_routine(const char *name, size_t length);

// SETTICK: calls the routine every `period_us`, first after one period; 0: no more. A tick that
// comes while its SUB cannot be called is called late, several of them once, and the next one is
// due in time.
void events_set_tick(unsigned tick, uint64_t period_us, basic_routine_t routine);

// Stops the clock of a tick where it is, or lets it go on.
void events_hold_tick(unsigned tick, bool hold);

// ON KEY code: this byte is not input but an event, wherever it comes from; -1: none.
void events_set_key_code(int code, basic_routine_t routine);

// Enters the SUB of an event if there is one to serve now: vm.pc is where the program goes on when
// it ends, vm.sp the first free place of the stack. True if one has been entered; all of vm is its
// then.
bool events_serve(void);

// The SUB has come to its end (calls_leave() knows by vm.interrupt_depth).
void events_left(void);

// When something falls due while nothing else happens, at most `until_us`.
uint64_t events_next_us(uint64_t until_us);

#endif
