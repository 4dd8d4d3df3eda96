// Watched pins. An interrupt takes note of an edge and masks its pin until main has asked; edges
// meanwhile are remembered by the chip, so none is missed and no input, however fast, takes the
// processor's time. Contexts: main; on_edge() in the GPIO interrupt, which the tick preempts.
#include "hal/hal.h"
#include "hal/hal_io.h"

#include "hardware/gpio.h"
#include "hardware/irq.h"

#include "rp2_port.h"

#define PINS_EACH 8u // in a register, four bits for each
#define PIN_BITS 4u
#define EDGE_BITS(edges)                                                                           \
    (((edges) & HAL_EDGE_RISING ? (uint32_t)GPIO_IRQ_EDGE_RISE : 0u) |                             \
     ((edges) & HAL_EDGE_FALLING ? (uint32_t)GPIO_IRQ_EDGE_FALL : 0u))
#define BOTH_EDGES EDGE_BITS(HAL_EDGE_BOTH)

static struct {
    uint8_t edges[PINS_COUNT]; // hal_edge_t; 0: not watched
    volatile uint32_t changed; // set by the interrupt, cleared by main
} watch;

static uint32_t place(unsigned gpio, uint32_t bits) {
    return bits << PIN_BITS * (gpio % PINS_EACH);
}

static io_rw_32 *enables(unsigned gpio) {
    return &io_bank0_hw->proc0_irq_ctrl.inte[gpio / PINS_EACH];
}

static void on_edge(void) {
    for (unsigned gpio = 0; gpio < PINS_COUNT; gpio++) {
        uint32_t due = io_bank0_hw->proc0_irq_ctrl.ints[gpio / PINS_EACH];
        if (due == 0) {
            gpio |= PINS_EACH - 1; // none of these
        } else if ((due & place(gpio, BOTH_EDGES)) != 0) {
            hw_clear_bits(enables(gpio), place(gpio, BOTH_EDGES));
            io_bank0_hw->intr[gpio / PINS_EACH] = place(gpio, BOTH_EDGES);
            watch.changed |= 1u << gpio;
        }
    }
    rp2_wake = true;
}

static void enable(unsigned gpio) {
    hw_set_bits(enables(gpio), place(gpio, EDGE_BITS(watch.edges[gpio])));
}

void hal_pin_watch(unsigned gpio, hal_edge_t edges) {
    static bool is_on;
    if (!is_on) {
        is_on = true;
        irq_set_exclusive_handler(IO_IRQ_BANK0, on_edge);
        rp2_irq_on(IO_IRQ_BANK0);
    }
    hal_pin_unwatch(gpio);
    io_bank0_hw->intr[gpio / PINS_EACH] = place(gpio, BOTH_EDGES); // what was before does not count
    watch.edges[gpio] = (uint8_t)edges;
    enable(gpio);
}

void hal_pin_unwatch(unsigned gpio) {
    hw_clear_bits(enables(gpio), place(gpio, BOTH_EDGES));
    rp2_irq_off(IO_IRQ_BANK0);
    watch.changed &= ~(1u << gpio);
    rp2_irq_on(IO_IRQ_BANK0);
    watch.edges[gpio] = 0;
}

uint32_t hal_pins_changed(void) {
    if (watch.changed == 0) {
        return 0;
    }
    rp2_irq_off(IO_IRQ_BANK0);
    uint32_t changed = watch.changed;
    watch.changed = 0;
    for (uint32_t rest = changed; rest != 0; rest &= rest - 1) {
        enable((unsigned)__builtin_ctz(rest));
    }
    rp2_irq_on(IO_IRQ_BANK0);
    return changed;
}
