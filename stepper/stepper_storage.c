// What writing the flash has to ask of motion: it stops every context for up to 50 ms, so nothing
// may move or be able to start by itself. An E-STOP input alone can wait that long. Context: main
// loop.
#include "stepper/governor.h"
#include "stepper/jog.h"
#include "stepper/planner.h"
#include "stepper/step_isr.h"

#define ENDING_US 5000u // the governor is at most half of it ahead

static bool paused; // the tick, between begin and end

// Nothing is queued any more: what the tick still executes ends within milliseconds.
static bool is_ending(void) {
    bool executing = governor_working() || (hal_tick_running() && !step_isr_watches());
    return executing && ring_used(&blocks.ring) == 0 && !jog_active();
}

// From here to the end the governor is held off: it could start something.
bool hal_on_storage_begin(void) {
    uint64_t limit_us = hal_time_us() + ENDING_US;
    while (is_ending() && hal_time_us() < limit_us) {
        hal_idle(limit_us);
    }
    hal_governor_lock();
    bool runs = hal_tick_running();
    if (governor_working() || (runs && !step_isr_watches())) {
        hal_governor_unlock();
        return false;
    }
    if (runs) {
        hal_tick_stop();
    }
    paused = runs && !step_isr_tripped();
    return true;
}

void hal_on_storage_end(void) {
    if (paused) {
        hal_tick_start();
    }
    hal_governor_unlock();
}
