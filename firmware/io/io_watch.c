// Inputs whose edges are told, for interrupts of a BASIC program. Context: main loop.
#include "io_watch.h"

#include "io.h"
#include "io_pins.h"

static uint32_t watched; // a mask

err_t io_set_interrupt(unsigned gpio, hal_edge_t edges, hal_pull_t pull) {
    err_t err = io_pins_check(gpio);
    if (err != ERR_OK) {
        return err;
    }
    io_pins_take(gpio, IO_PINS_INTERRUPT);
    hal_pin_input(gpio, pull);
    hal_wait_us(1); // the pull has to have its effect, or its edge would be the first to be told
    watched |= pins_mask(gpio);
    hal_pin_watch(gpio, edges);
    return ERR_OK;
}

void io_watch_stop(unsigned gpio) {
    watched &= ~pins_mask(gpio);
    hal_pin_unwatch(gpio);
}

uint32_t io_changed(void) {
    return watched == 0 ? 0 : hal_pins_changed() & watched;
}
