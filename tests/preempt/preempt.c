// The instrumentation is that of gcc's thread sanitizer, whose runtime is not linked: what the
// compiler calls before each access is below. Accesses to local variables that never leave their
// function are not among them; they cannot be part of a race.
#include "preempt.h"

#include <string.h>

#include "hal/hal.h"
#include "host_clock.h"
#include "host_tick.h"
#include "preempt_hooks.h"
#include "preempt_locks.h"

#define SITES_MAX 64
// The governor and what locks it may take this many ticks in one go, and a third of the time in the
// long run. The segment ring has to ride out no more.
#define BUSY_TICKS_MAX 50
#define TICK_NS 10000u

preempt_counts_t preempt_counts;

static struct {
    bool on;
    uint64_t random;
    unsigned interval;      // accesses between two interrupts, in the mean
    unsigned accesses;      // left until the next
    uint64_t busy_until_ns; // when the debt of ticks taken will be paid
    void (*action)(void);
    unsigned action_in; // accesses
    const char *unlocked;
    const char *sites[SITES_MAX];
} preempt;

// xorshift64*: a stream of its own, so that the session's choices stay what they are.
static unsigned below(unsigned limit) {
    preempt.random ^= preempt.random >> 12;
    preempt.random ^= preempt.random << 25;
    preempt.random ^= preempt.random >> 27;
    return (unsigned)(((preempt.random * 0x2545F4914F6CDD1Du >> 32) * limit) >> 32);
}

static void arm(void) {
    preempt.accesses = 1 + below(2 * preempt.interval);
}

void preempt_begin(uint64_t seed) {
    static const unsigned intervals[] = {2, 5, 12, 30, 70, 150, 300};
    preempt.random = seed * 0x9E3779B97F4A7C15u + 1;
    below(1);
    preempt.interval = intervals[below(COUNT_OF_ARRAY(intervals))];
    preempt.on = true;
    arm();
}

void preempt_end(void) {
    preempt.on = false;
    preempt.action = NULL;
}

void preempt_do_soon(void (*action)(void)) {
    preempt.action = action;
    preempt.action_in = 1 + below(3000);
}

// The governor and what locks it have to be done in time, so interrupts cannot stretch them for
// ever.
static bool may_take_longer(void) {
    uint64_t now_ns = host_clock_now_ns();
    if (preempt.busy_until_ns < now_ns) {
        preempt.busy_until_ns = now_ns;
    }
    if (preempt.busy_until_ns - now_ns > 2 * BUSY_TICKS_MAX * TICK_NS) {
        return false;
    }
    preempt.busy_until_ns += 3 * TICK_NS; // one is over when the tick is
    return true;
}

// Mostly one tick; the main loop may also stand still for a while.
static void interrupt(void) {
    arm();
    switch (host_tick_context()) {
    case HOST_TICK_MAIN:
        for (unsigned ticks = below(20) > 0 ? 1 : 1 + below(200); ticks > 0; ticks--) {
            host_tick_interrupt();
            preempt_counts.in_main++;
        }
        break;
    case HOST_TICK_LOCKED:
        if (may_take_longer()) {
            preempt_counts.in_locked++;
            host_tick_interrupt();
        }
        break;
    case HOST_TICK_GOVERNOR:
        if (may_take_longer()) {
            preempt_counts.in_governor++;
            host_tick_interrupt();
        }
        break;
    case HOST_TICK_TICK:
        break; // nothing is above it
    }
}

static void on_access(void) {
    if (!preempt.on) {
        return;
    }
    if (preempt.action != NULL && --preempt.action_in == 0) {
        void (*action)(void) = preempt.action;
        preempt.action = NULL;
        action();
    }
    if (--preempt.accesses == 0) {
        interrupt();
    }
}

// ---- Locks --------------------------------------------------------------------------------------

void preempt_plant_unlocked(const char *function) {
    preempt.unlocked = function;
}

const char *preempt_lock_site(unsigned index) {
    return index < SITES_MAX ? preempt.sites[index] : NULL;
}

void preempt_lock(const char *function) {
    unsigned site = 0;
    while (site < SITES_MAX - 1 && preempt.sites[site] != NULL && preempt.sites[site] != function) {
        site++;
    }
    preempt.sites[site] = function;
    if (preempt.unlocked == NULL || strcmp(function, preempt.unlocked) != 0) {
        (hal_governor_lock)(); // the real one
    }
}

// ---- What the compiler calls --------------------------------------------------------------------

void __tsan_init(void) {}

#define ON_ACCESS(name)                                                                            \
    void name(void *address) {                                                                     \
        (void)address;                                                                             \
        on_access();                                                                               \
    }

ON_ACCESS(__tsan_read1)
ON_ACCESS(__tsan_read2)
ON_ACCESS(__tsan_read4)
ON_ACCESS(__tsan_read8)
ON_ACCESS(__tsan_read16)
ON_ACCESS(__tsan_write1)
ON_ACCESS(__tsan_write2)
ON_ACCESS(__tsan_write4)
ON_ACCESS(__tsan_write8)
ON_ACCESS(__tsan_write16)
ON_ACCESS(__tsan_unaligned_read2)
ON_ACCESS(__tsan_unaligned_read4)
ON_ACCESS(__tsan_unaligned_read8)
ON_ACCESS(__tsan_unaligned_read16)
ON_ACCESS(__tsan_unaligned_write2)
ON_ACCESS(__tsan_unaligned_write4)
ON_ACCESS(__tsan_unaligned_write8)
ON_ACCESS(__tsan_unaligned_write16)

void __tsan_read_range(void *address, unsigned long size) {
    (void)address;
    (void)size;
    on_access();
}

void __tsan_write_range(void *address, unsigned long size) {
    (void)address;
    (void)size;
    on_access();
}
