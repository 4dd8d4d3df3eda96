// Frequency, period and number of edges of a pin. The board counts; here are the gates that make a
// frequency of it. Contexts: main; io_count_run() alarm.
#include "io_count.h"

#include "io.h"
#include "io_alarm.h"
#include "io_pins.h"

// A counter of the board has 32 bits: at 20 MHz it comes round in 214 s. So often it is looked at.
#define LOOK_US 60000000u

typedef struct {
    bool used;
    bool gated; // frequency or edges, not a period
    uint8_t gpio;
    uint32_t periods; // what a period is the mean of
    uint32_t gate_us;
    uint64_t opened_us;
    uint32_t opened_at;   // what the counter was then
    uint32_t edges;       // in the last complete gate
    uint32_t measured_us; // how long that was; 0: there was none yet
    int64_t total;        // up to opened_at
} count_t;

static count_t counts[HAL_COUNTERS]; // written by main with the alarm locked, and by the alarm

static count_t *find(unsigned gpio) {
    for (unsigned i = 0; i < HAL_COUNTERS; i++) {
        if (counts[i].used && counts[i].gpio == gpio) {
            return &counts[i];
        }
    }
    return NULL;
}

static unsigned index_of(const count_t *count) {
    return (unsigned)(count - counts);
}

// ---- Gates --------------------------------------------------------------------------------------

uint64_t io_count_next_us(void) {
    uint64_t next_us = UINT64_MAX;
    for (unsigned i = 0; i < HAL_COUNTERS; i++) {
        uint64_t close_us = counts[i].opened_us + counts[i].gate_us;
        if (counts[i].used && counts[i].gated && close_us < next_us) {
            next_us = close_us;
        }
    }
    return next_us;
}

static void close_gate(count_t *count, uint64_t now_us) {
    uint32_t now_at = hal_counter_read(index_of(count));
    count->edges = now_at - count->opened_at;
    count->measured_us = (uint32_t)(now_us - count->opened_us);
    count->total += count->edges;
    count->opened_at = now_at;
    count->opened_us = now_us;
}

void io_count_run(uint64_t now_us) {
    for (unsigned i = 0; i < HAL_COUNTERS; i++) {
        count_t *count = &counts[i];
        if (count->used && count->gated && count->opened_us + count->gate_us <= now_us) {
            close_gate(count, now_us);
        }
    }
}

// ---- Start and end ------------------------------------------------------------------------------

void io_count_stop(unsigned gpio) {
    count_t *count = find(gpio);
    if (count != NULL) {
        hal_alarm_lock();
        count->used = false;
        io_alarm_update();
        hal_alarm_unlock();
        hal_counter_stop(index_of(count));
    }
}

// Makes the pin an input with a counter of its own.
static err_t take(unsigned gpio, io_pins_use_t use, hal_pull_t pull, count_t **count) {
    err_t err = io_pins_check(gpio);
    if (err != ERR_OK) {
        return err;
    }
    unsigned i = 0;
    while (i < HAL_COUNTERS && counts[i].used && counts[i].gpio != gpio) {
        i++;
    }
    if (i == HAL_COUNTERS) {
        return err_raise(ERR_TOO_MANY_COUNTERS, "%s", pins_name(gpio));
    }
    io_pins_take(gpio, use); // gives the pin's own counter back, if it had one
    hal_pin_input(gpio, pull);
    hal_wait_us(1); // the pull has to have its effect, or its edge would be counted
    *count = &counts[i];
    **count = (count_t){.gpio = (uint8_t)gpio};
    return ERR_OK;
}

static void open_gate(count_t *count, hal_edge_t edges, uint32_t gate_us) {
    hal_counter_start(index_of(count), count->gpio, edges);
    hal_alarm_lock();
    count->gate_us = gate_us;
    count->opened_us = hal_time_us();
    count->gated = true;
    count->used = true;
    io_alarm_update();
    hal_alarm_unlock();
}

err_t io_set_frequency(unsigned gpio, uint32_t gate_ms) {
    count_t *count;
    err_t err = take(gpio, IO_PINS_FREQUENCY, HAL_PULL_NONE, &count);
    if (err == ERR_OK) {
        open_gate(count, HAL_EDGE_RISING, gate_ms * 1000u);
    }
    return err;
}

err_t io_set_counter(unsigned gpio, hal_edge_t edges, hal_pull_t pull) {
    count_t *count;
    err_t err = take(gpio, IO_PINS_COUNTER, pull, &count);
    if (err == ERR_OK) {
        open_gate(count, edges, LOOK_US);
    }
    return err;
}

err_t io_set_period(unsigned gpio, uint32_t periods) {
    count_t *count;
    err_t err = take(gpio, IO_PINS_PERIOD, HAL_PULL_NONE, &count);
    if (err == ERR_OK) {
        count->periods = periods;
        count->used = true;
        hal_period_start(index_of(count), gpio, periods);
    }
    return err;
}

// ---- Readings -----------------------------------------------------------------------------------

// The gate closes some microseconds late: what those add to a long gate would only look like a
// strange frequency. If it was held up for longer, it counts as it was.
double io_count_hz(unsigned gpio) {
    const count_t *count = find(gpio);
    hal_alarm_lock();
    uint32_t edges = count->edges;
    uint32_t measured_us = count->measured_us;
    hal_alarm_unlock();
    if (measured_us == 0) {
        return 0.0;
    }
    bool punctual = measured_us - count->gate_us <= count->gate_us / 1000u + 20u;
    return (double)edges * 1e6 / (double)(punctual ? count->gate_us : measured_us);
}

double io_count_period_ms(unsigned gpio) {
    const count_t *count = find(gpio);
    return hal_period_read(index_of(count)) * 1000.0 / (double)count->periods;
}

int64_t io_count_edges(unsigned gpio) {
    count_t *count = find(gpio);
    hal_alarm_lock();
    int64_t edges = count->total + (int64_t)(hal_counter_read(index_of(count)) - count->opened_at);
    hal_alarm_unlock();
    return edges;
}

void io_count_set(unsigned gpio, int64_t edges) {
    count_t *count = find(gpio);
    hal_alarm_lock();
    count->opened_at = hal_counter_read(index_of(count));
    count->total = edges;
    hal_alarm_unlock();
}
