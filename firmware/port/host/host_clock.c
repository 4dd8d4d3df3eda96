// Moves virtual time from event to event. Context: main; reading the time: any.
#include "host_clock.h"

#include "hal/hal.h"
#include "host_inputs.h"
#include "host_tick.h"

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

uint64_t host_clock_next_event_ns(void) {
    uint64_t tick_ns = host_tick_next_ns();
    uint64_t input_ns = host_inputs_next_ns();
    return tick_ns < input_ns ? tick_ns : input_ns;
}

bool host_clock_run(uint64_t until_ns, bool stop_on_news) {
    bool news = false;
    while (host_clock_next_event_ns() <= until_ns) {
        uint64_t input_ns = host_inputs_next_ns();
        if (input_ns <= host_tick_next_ns()) {
            clock_now_ns = input_ns;
            host_inputs_apply(input_ns);
            news = true;
        } else {
            uint64_t before_ns = input_ns <= until_ns ? input_ns - 1 : until_ns;
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
