// Levels and directions of the pins; tells the recorder and the simulations about every edge.
// Context: any.
#include "host_pads.h"

#include "hal/hal.h"
#include "hal/hal_io.h"
#include "host_clock.h"
#include "host_counters.h"
#include "host_pwm.h"
#include "host_system.h"
#include "host_trace.h"
#include "host_wire.h"
#include "simulate.h"

static struct {
    uint32_t outputs;       // pins the firmware drives
    uint32_t output_levels; // and how
    uint32_t driven;        // pins the outside world drives
    uint32_t driven_levels; // and how
    uint32_t pull_up;
    uint32_t levels; // what the pads show: follows from all of the above
} pads;

// Takes the new levels over. `recorded` are the changed pins that belong into the trace.
static void show(uint32_t levels, uint32_t recorded) {
    uint32_t changed = pads.levels ^ levels;
    pads.levels = levels;
    if (changed != 0) {
        host_trace_edges(host_clock_now_ns(), changed & recorded, levels);
        host_counters_edges(host_clock_now_ns(), changed, levels);
        host_wire_edges(host_clock_now_ns(), changed, levels);
        simulate_edges(host_clock_now_ns(), changed, levels);
    }
}

// Pins that were or are an output are recorded; so a high output that is given back leaves a row.
static void settle(uint32_t outputs_before) {
    uint32_t undriven = (pads.driven & pads.driven_levels) | (~pads.driven & pads.pull_up);
    uint32_t levels = (pads.outputs & pads.output_levels) | (~pads.outputs & undriven);
    show(levels, outputs_before | pads.outputs);
}

void hal_pins_set(uint32_t mask) {
    mask &= pads.outputs & ~pads.output_levels;
    if (mask != 0) {
        pads.output_levels |= mask;
        show(pads.levels | mask, mask);
    }
}

void hal_pins_clear(uint32_t mask) {
    mask &= pads.outputs & pads.output_levels;
    if (mask != 0) {
        pads.output_levels &= ~mask;
        show(pads.levels & ~mask, mask);
    }
}

uint32_t hal_pins_read(void) {
    uint32_t pwm = host_pwm_pins();
    return pwm == 0 ? pads.levels : (pads.levels & ~pwm) | host_pwm_levels();
}

static uint32_t checked_mask(unsigned gpio) {
    if (gpio >= PINS_COUNT) {
        host_system_fail("the firmware used GPIO %u, which does not exist", gpio);
    }
    return (uint32_t)1 << gpio;
}

static void set_bits(uint32_t *word, uint32_t mask, bool on) {
    *word = on ? *word | mask : *word & ~mask;
}

void hal_pin_output(unsigned gpio, bool level) {
    uint32_t mask = checked_mask(gpio);
    uint32_t before = pads.outputs;
    host_pwm_remove(gpio);
    pads.outputs |= mask;
    pads.pull_up &= ~mask;
    set_bits(&pads.output_levels, mask, level);
    settle(before);
}

void hal_pin_input(unsigned gpio, hal_pull_t pull) {
    uint32_t mask = checked_mask(gpio);
    uint32_t before = pads.outputs;
    host_pwm_remove(gpio);
    pads.outputs &= ~mask;
    set_bits(&pads.pull_up, mask, pull == HAL_PULL_UP);
    settle(before);
}

void hal_pin_release(unsigned gpio) {
    hal_pin_input(gpio, HAL_PULL_NONE);
}

void hal_pin_analog(unsigned gpio) {
    hal_pin_input(gpio, HAL_PULL_NONE);
}

// What the pad shows without its slice is low: it counts as an input nobody drives.
void hal_pin_pwm(unsigned gpio) {
    hal_pin_input(gpio, HAL_PULL_NONE);
    host_pwm_add(gpio);
}

void host_pads_drive(unsigned gpio, bool level) {
    uint32_t mask = checked_mask(gpio);
    pads.driven |= mask;
    set_bits(&pads.driven_levels, mask, level);
    settle(pads.outputs);
}

void host_pads_let_go(unsigned gpio) {
    pads.driven &= ~checked_mask(gpio);
    settle(pads.outputs);
}
