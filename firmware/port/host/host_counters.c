// Counters, periods and watched pins, fed by every edge of the pads. Context: any.
#include "host_counters.h"

#include <string.h>

#include "hal/hal.h"
#include "hal/hal_io.h"

static struct {
    struct {
        uint32_t pin; // a mask; 0: not in use
        hal_edge_t edges;
        uint32_t count;
        uint32_t periods;  // 0: it only counts
        uint64_t began_ns; // the measurement under way, at its first edge; 0: none yet
        uint64_t took_ns;  // the last complete one
    } counters[HAL_COUNTERS];
    uint32_t rising, falling; // watched pins
    uint32_t changed;
} watch;

static void count_edge(unsigned i, uint64_t time_ns) {
    if (watch.counters[i].periods == 0) {
        watch.counters[i].count++;
        return;
    }
    if (watch.counters[i].began_ns == 0) {
        watch.counters[i].began_ns = time_ns;
        watch.counters[i].count = 0;
    } else if (++watch.counters[i].count == watch.counters[i].periods) {
        watch.counters[i].took_ns = time_ns - watch.counters[i].began_ns;
        watch.counters[i].began_ns = time_ns;
        watch.counters[i].count = 0;
    }
}

void host_counters_edges(uint64_t time_ns, uint32_t changed, uint32_t levels) {
    watch.changed |= changed & ((levels & watch.rising) | (~levels & watch.falling));
    for (unsigned i = 0; i < HAL_COUNTERS; i++) {
        uint32_t pin = changed & watch.counters[i].pin;
        hal_edge_t edge = (levels & pin) != 0 ? HAL_EDGE_RISING : HAL_EDGE_FALLING;
        if (pin != 0 && (watch.counters[i].edges & edge) != 0) {
            count_edge(i, time_ns);
        }
    }
}

void hal_counter_start(unsigned counter, unsigned gpio, hal_edge_t edges) {
    hal_counter_stop(counter);
    watch.counters[counter].pin = pins_mask(gpio);
    watch.counters[counter].edges = edges;
}

uint32_t hal_counter_read(unsigned counter) {
    return watch.counters[counter].count;
}

void hal_period_start(unsigned counter, unsigned gpio, uint32_t periods) {
    hal_counter_start(counter, gpio, HAL_EDGE_RISING);
    watch.counters[counter].periods = periods;
}

double hal_period_read(unsigned counter) {
    return (double)watch.counters[counter].took_ns * 1e-9;
}

void hal_counter_stop(unsigned counter) {
    memset(&watch.counters[counter], 0, sizeof watch.counters[counter]);
}

void hal_pin_watch(unsigned gpio, hal_edge_t edges) {
    hal_pin_unwatch(gpio);
    watch.rising |= (edges & HAL_EDGE_RISING) != 0 ? pins_mask(gpio) : 0;
    watch.falling |= (edges & HAL_EDGE_FALLING) != 0 ? pins_mask(gpio) : 0;
}

void hal_pin_unwatch(unsigned gpio) {
    watch.rising &= ~pins_mask(gpio);
    watch.falling &= ~pins_mask(gpio);
    watch.changed &= ~pins_mask(gpio);
}

uint32_t hal_pins_changed(void) {
    uint32_t changed = watch.changed;
    watch.changed = 0;
    return changed;
}
