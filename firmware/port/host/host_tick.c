// Calls the core's tick and governor, as the interrupts of a board would. One thread plays all
// contexts, so "interrupts" are calls between two statements of the one below. Context: any.
#include "host_tick.h"

#include "hal/hal.h"
#include "host_clock.h"

#define TICK_NS (1000000000u / HAL_TICK_HZ)

static struct {
    uint64_t next_ns; // of the coming tick
    bool running;
    bool governor_pending; // asked for and not yet begun
    bool governor_locked;
    bool news; // governor ran or tick stopped since host_tick_run() looked
    host_tick_context_t context;
} tick;

uint64_t host_tick_next_ns(void) {
    return tick.running ? tick.next_ns : HOST_CLOCK_NEVER;
}

// From main's level only: the governor interrupts neither the tick nor itself. A request made while
// it runs brings it again, as a pending interrupt does.
static void governor_if_due(void) {
    while (tick.governor_pending && !tick.governor_locked) {
        tick.governor_pending = false;
        tick.news = true;
        tick.context = HOST_TICK_GOVERNOR;
        hal_on_governor();
        tick.context = HOST_TICK_MAIN;
    }
}

static void run_tick(void) {
    host_tick_context_t interrupted = tick.context;
    host_clock_set_ns(tick.next_ns);
    tick.next_ns += TICK_NS;
    tick.context = HOST_TICK_TICK;
    hal_on_tick();
    tick.context = interrupted;
}

bool host_tick_run(uint64_t until_ns, bool stop_on_news) {
    tick.news = false;
    while (tick.running && tick.next_ns <= until_ns && !(tick.news && stop_on_news)) {
        run_tick();
        governor_if_due();
    }
    return tick.news;
}

host_tick_context_t host_tick_context(void) {
    return tick.context == HOST_TICK_MAIN && tick.governor_locked ? HOST_TICK_LOCKED : tick.context;
}

void host_tick_interrupt(void) {
    if (!tick.running || tick.context == HOST_TICK_TICK) {
        return;
    }
    run_tick();
    if (tick.context == HOST_TICK_MAIN) {
        governor_if_due();
    }
}

void hal_tick_start(void) {
    if (!tick.running) {
        tick.running = true;
        tick.next_ns = host_clock_now_ns() + TICK_NS;
    }
}

void hal_tick_stop(void) {
    tick.news |= tick.running;
    tick.running = false;
}

bool hal_tick_running(void) {
    return tick.running;
}

void hal_governor_request(void) {
    tick.governor_pending = true;
    if (tick.context == HOST_TICK_MAIN) {
        governor_if_due();
    }
}

void hal_governor_lock(void) {
    tick.governor_locked = true;
}

void hal_governor_unlock(void) {
    tick.governor_locked = false;
    if (tick.context == HOST_TICK_MAIN) {
        governor_if_due();
    }
}
