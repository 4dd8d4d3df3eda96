// Interrupts at random places. The parts under test are compiled so that they call preempt.c before
// each access to memory; there a tick may come, and the governor behind it, as on a board. Repeats
// exactly with the same seed. Context: any.
#ifndef PREEMPT_H
#define PREEMPT_H

#include <stdbool.h>
#include <stdint.h>

// From now on interrupts come, as often as the seed says: in some runs behind every other access,
// in some a few in the whole run.
void preempt_begin(uint64_t seed);
void preempt_end(void);

// Ticks that came into the main loop, into a section with the governor locked, and into the
// governor.
typedef struct {
    uint64_t in_main, in_locked, in_governor;
} preempt_counts_t;

extern preempt_counts_t preempt_counts;

// Has `action` called by the hardware, so to speak: within the next accesses, once. NULL: not any
// more.
void preempt_do_soon(void (*action)(void));

// Planted race: in this function hal_governor_lock() is without effect. NULL: none.
void preempt_plant_unlocked(const char *function);

// The functions that have locked the governor so far; NULL after the last.
const char *preempt_lock_site(unsigned index);

#endif
