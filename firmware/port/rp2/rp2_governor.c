// The governor's interrupt: a line of the NVIC that no peripheral uses, pended by software, below
// every other interrupt. Context: main; governor_irq() is the governor's own.
#include "hal/hal.h"

#include "hardware/irq.h"

#include "rp2_port.h"

static void governor_irq(void) {
    hal_on_governor();
    rp2_wake = true; // it may have made room in a queue that main waits for
}

void rp2_governor_init(void) {
    user_irq_claim(RP2_GOVERNOR_IRQ);
    irq_set_exclusive_handler(RP2_GOVERNOR_IRQ, governor_irq);
    irq_set_priority(RP2_GOVERNOR_IRQ, RP2_PRIORITY_GOVERNOR);
    rp2_irq_on(RP2_GOVERNOR_IRQ);
}

void hal_governor_lock(void) {
    rp2_irq_off(RP2_GOVERNOR_IRQ);
}

void hal_governor_unlock(void) {
    rp2_irq_on(RP2_GOVERNOR_IRQ);
}
