// Moves virtual time from event to event. Context: main; reading the time: any.
#include "host_clock.h"

#include "hal/hal.h"
#include "host_alarm.h"
#include "host_inputs.h"
#include "host_serial.h"
#include "host_tick.h"
#include "host_wire.h"
#include "simulate.h"
#include "simulate_wire.h"

static uint64_t clock_now_ns;

uint64_t host_clock_now_ns(void) {
    return clock_now_ns;
}

void host_clock_set_ns(uint64_t now_ns) {
    clock_now_ns = now_ns;
}

uint64_t hal_time_us(void) {
    return clock_now_ns / 1000;
}

static uint64_t min_ns(uint64_t a, uint64_t b) {
    return a < b ? a : b;
}

// The next event that is no tick.
static uint64_t next_other_ns(void) {
    uint64_t next_ns = min_ns(host_inputs_next_ns(), host_alarm_next_ns());
    next_ns = min_ns(next_ns, host_serial_next_ns());
    next_ns = min_ns(next_ns, simulate_next_ns());
    next_ns = min_ns(next_ns, simulate_wire_next_ns());
    return min_ns(next_ns, host_wire_next_ns());
}

uint64_t host_clock_next_event_ns(void) {
    uint64_t tick_ns = host_tick_next_ns();
    uint64_t other_ns = next_other_ns();
    return tick_ns < other_ns ? tick_ns : other_ns;
}

// The input edge, the received byte, the bit of a wire or the alarm that is due at `now_ns`. True:
// something for the main loop to see.
static bool run_other(uint64_t now_ns) {
    clock_now_ns = now_ns;
    if (host_inputs_next_ns() <= now_ns) {
        host_inputs_apply(now_ns);
        return true;
    }
    if (host_serial_next_ns() <= now_ns) {
        host_serial_notice(now_ns);
        return true;
    }
    if (simulate_next_ns() <= now_ns) {
        simulate_run(now_ns);
        return true;
    }
    if (simulate_wire_next_ns() <= now_ns) { // before the firmware samples the same bit
        simulate_wire_run(now_ns);
        return false;
    }
    if (host_wire_next_ns() <= now_ns) {
        return host_wire_run(now_ns);
    }
    host_alarm_run();
    return false;
}

bool host_clock_run(uint64_t until_ns, bool stop_on_news) {
    bool news = false;
    while (host_clock_next_event_ns() <= until_ns) {
        uint64_t other_ns = next_other_ns();
        if (other_ns <= host_tick_next_ns()) {
            news |= run_other(other_ns);
        } else {
            uint64_t before_ns = other_ns <= until_ns ? other_ns - 1 : until_ns;
            news |= host_tick_run(before_ns, stop_on_news);
        }
        if (news && stop_on_news) {
            return true;
        }
    }
    if (until_ns > clock_now_ns) {
        clock_now_ns = until_ns;
    }
    return news;
}
