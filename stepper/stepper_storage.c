// What writing the flash has to ask of motion: it stops every context for up to 50 ms, so nothing
// may move or be able to start by itself. An E-STOP input alone can wait that long. Context: main
// loop.
#include "stepper/machine.h"
#include "stepper/step_isr.h"

static bool paused; // the tick, between begin and end

// From here to the end the governor is held off: it could start something.
bool hal_on_storage_begin(void) {
    machine_await_end();
    hal_governor_lock();
    if (machine_executing()) {
        hal_governor_unlock();
        return false;
    }
    bool runs = hal_tick_running();
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
