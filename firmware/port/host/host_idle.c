// Waiting. In virtual time hal_idle() jumps: input that is there is taken first, then time goes on
// to the next event. In real time it sleeps, and virtual time catches up with wall time. Context:
// main.
#include "host_idle.h"

#include <stdlib.h>

#include "hal/hal.h"
#include "host_clock.h"
#include "host_console.h"
#include "host_signals.h"
#include "host_system.h"

#define STATEMENT_NS 20000u      // what a BASIC statement costs, about as on a board
#define BATCH_NS 1000000u        // longest run of ticks between two looks at the main loop
#define PATIENCE_NS 50000000u    // wall time given to a peer that may be about to send
#define CATCH_UP_NS 100000000u   // longest delay that real time makes up for
#define SLEEP_MAX_NS 2000000000u // of real time: a board wakes as often, to feed its watchdog
#define HOPELESS_IDLES_MAX 1000u // waits that nothing can end, before giving up

static struct {
    bool realtime;
    uint64_t wall_zero_ns;     // wall time at virtual time 0; real time only
    uint64_t patience_left_ns; // wall time; renewed by input
    unsigned hopeless_idles;
} idle;

void host_idle_init(bool realtime) {
    idle.realtime = realtime;
    idle.wall_zero_ns = host_signals_wall_ns() - host_clock_now_ns();
    idle.patience_left_ns = PATIENCE_NS;
}

static uint64_t min_ns(uint64_t a, uint64_t b) {
    return a < b ? a : b;
}

// A batch ends here at the latest, so that the main loop runs about once a millisecond, as it would
// on a board, while there are ticks.
static uint64_t batch_end_ns(void) {
    return hal_tick_running() ? host_clock_now_ns() + BATCH_NS : HOST_CLOCK_NEVER;
}

// Nothing but new input could end this wait, and there will be none. The caller should have asked
// hal_end_of_input(); it gets a few chances to do so.
static void wait_hopelessly(void) {
    if (++idle.hopeless_idles > HOPELESS_IDLES_MAX) {
        host_system_fail("the input has ended, and nothing is left that could end the wait");
    }
}

// ---- Virtual time -------------------------------------------------------------------------------

// True if input came while waiting for a peer that may be about to send.
static bool wait_patiently(void) {
    if (host_console_at_end() || idle.patience_left_ns == 0) {
        return false;
    }
    uint64_t begin_ns = host_signals_wall_ns();
    host_console_wait(idle.patience_left_ns);
    uint64_t spent_ns = host_signals_wall_ns() - begin_ns;
    idle.patience_left_ns -= min_ns(spent_ns, idle.patience_left_ns);
    return host_console_has_news();
}

static void idle_virtual(uint64_t until_ns) {
    host_console_poll();
    if (host_console_has_news()) {
        idle.patience_left_ns = PATIENCE_NS;
        return;
    }
    if (host_console_is_blocked()) { // the world stands still for a reader who is slow
        host_console_wait(UINT64_MAX);
        return;
    }
    if (until_ns == HOST_CLOCK_NEVER) {
        if (wait_patiently()) {
            idle.patience_left_ns = PATIENCE_NS;
            return;
        }
        until_ns = host_clock_next_event_ns();
        if (until_ns == HOST_CLOCK_NEVER) {
            if (host_console_at_end()) {
                wait_hopelessly();
            } else {
                host_console_wait(UINT64_MAX);
            }
            return;
        }
        until_ns = hal_tick_running() ? batch_end_ns() : until_ns;
    }
    host_clock_run(min_ns(until_ns, batch_end_ns()), true);
}

// ---- Real time ----------------------------------------------------------------------------------

// What virtual time should be by now. It was expected to be about `expected_ns`; a program that was
// stopped or slow does not make up for all of the difference.
static uint64_t due_ns(uint64_t expected_ns) {
    uint64_t wall_ns = host_signals_wall_ns() - idle.wall_zero_ns;
    if (wall_ns > expected_ns && wall_ns - expected_ns > CATCH_UP_NS) {
        idle.wall_zero_ns += wall_ns - expected_ns - CATCH_UP_NS;
        return expected_ns + CATCH_UP_NS;
    }
    return wall_ns;
}

static void idle_realtime(uint64_t until_ns) {
    host_console_poll();
    bool news = host_clock_run(min_ns(due_ns(host_clock_now_ns()), until_ns), true);
    if (host_console_has_news() || news || host_clock_now_ns() >= until_ns) {
        return;
    }
    uint64_t event_ns = host_clock_next_event_ns();
    if (event_ns == HOST_CLOCK_NEVER && until_ns == HOST_CLOCK_NEVER && host_console_at_end() &&
        !host_console_is_blocked()) {
        wait_hopelessly();
        return;
    }
    uint64_t wake_ns = min_ns(until_ns, hal_tick_running() ? batch_end_ns() : event_ns);
    wake_ns = min_ns(wake_ns, host_clock_now_ns() + SLEEP_MAX_NS);
    uint64_t now_ns = due_ns(host_clock_now_ns());
    host_console_wait(wake_ns - min_ns(now_ns, wake_ns));
    host_clock_run(min_ns(due_ns(wake_ns), until_ns), true);
}

// ---- The seam -----------------------------------------------------------------------------------

void hal_idle(uint64_t until_us) {
    host_signals_check();
    uint64_t before_ns = host_clock_now_ns();
    uint64_t until_ns = until_us > HOST_CLOCK_NEVER / 1000 ? HOST_CLOCK_NEVER : until_us * 1000;
    if (idle.realtime) {
        idle_realtime(until_ns);
    } else {
        idle_virtual(until_ns);
    }
    if (host_clock_now_ns() != before_ns) {
        idle.hopeless_idles = 0;
    }
    host_signals_check();
}

bool hal_statement(void) {
    host_signals_check();
    if (idle.realtime) {
        host_clock_run(due_ns(host_clock_now_ns()), false);
    } else {
        host_clock_run(host_clock_now_ns() + STATEMENT_NS, false);
    }
    return host_console_take_came();
}
