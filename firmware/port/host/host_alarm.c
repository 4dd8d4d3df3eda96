// The alarm, as a plain call at its virtual time, and short waits. Context: main.
#include "host_alarm.h"

#include <stddef.h>

#include "hal/hal.h"
#include "hal/hal_io.h"
#include "host_clock.h"

static struct {
    uint64_t at_ns;
    hal_alarm_t handler; // NULL: none
} pending;

uint64_t host_alarm_next_ns(void) {
    return pending.handler != NULL ? pending.at_ns : HOST_CLOCK_NEVER;
}

void host_alarm_run(void) {
    hal_alarm_t handler = pending.handler;
    pending.handler = NULL;
    handler();
}

void hal_alarm_set(uint64_t at_us, hal_alarm_t handler) {
    pending.handler = at_us < HOST_CLOCK_NEVER / 1000 ? handler : NULL;
    pending.at_ns = at_us * 1000;
    if (pending.handler != NULL && pending.at_ns < host_clock_now_ns()) {
        pending.at_ns = host_clock_now_ns();
    }
}

// Virtual time stands still while the main loop computes: nothing has to be held off.
void hal_alarm_lock(void) {}
void hal_alarm_unlock(void) {}

void hal_wait_us(uint32_t us) {
    host_clock_run(host_clock_now_ns() + us * UINT64_C(1000), false);
}
