// Time, and sleeping until something happened. Context: main; on_alarm() in the timer's interrupt.
//
// No wake-up is lost: whoever has news for main is an interrupt and sets rp2_wake, and an interrupt
// taken between our look at rp2_wake and the WFE leaves the core's event register set, so that WFE
// falls through. A running tick wakes the core 100,000 times a second, but not main: that takes
// rp2_wake.
#include "hal/hal.h"

#include "hardware/timer.h"
#include "pico/time.h"

#include "rp2_port.h"

volatile bool rp2_wake;
volatile bool rp2_input_came;

static unsigned idle_alarm;

static void on_alarm(unsigned alarm) {
    (void)alarm;
    rp2_wake = true;
}

void rp2_idle_init(void) {
    idle_alarm = (unsigned)hardware_alarm_claim_unused(true);
    hardware_alarm_set_callback(idle_alarm, on_alarm);
}

uint64_t hal_time_us(void) {
    return time_us_64();
}

void hal_idle(uint64_t until_us) {
    rp2_fault_feed();
    // The watchdog has to be fed however long main waits: returning early is allowed.
    uint64_t wake_us = time_us_64() + RP2_FAULT_FEED_US;
    if (until_us < wake_us) {
        wake_us = until_us;
    }
    bool missed = hardware_alarm_set_target(idle_alarm, from_us_since_boot(wake_us));
    while (!missed && !rp2_wake) {
        __wfe();
    }
    rp2_wake = false;
}

bool hal_statement(void) {
    rp2_fault_feed();
    bool came = rp2_input_came;
    if (came) {
        rp2_input_came = false; // what comes behind this line sets it again
    }
    return came;
}
