// Observers of the pins and the simulated axes. Context: any.
#include "simulate.h"

#include "host_pads.h"
#include "simulate_tmc_wire.h"

static struct {
    struct {
        simulate_observer_t call;
        void *state;
    } observers[SIMULATE_OBSERVERS_MAX];
    unsigned count;
} simulate;

bool simulate_observe(simulate_observer_t observer, void *state) {
    if (simulate.count == SIMULATE_OBSERVERS_MAX) {
        return false;
    }
    simulate.observers[simulate.count].call = observer;
    simulate.observers[simulate.count].state = state;
    simulate.count++;
    return true;
}

void simulate_edges(uint64_t time_ns, uint32_t changed, uint32_t levels) {
    for (unsigned i = 0; i < simulate.count; i++) {
        simulate.observers[i].call(simulate.observers[i].state, time_ns, changed, levels);
    }
}

static bool is_missed(const simulate_axis_t *axis) {
    return axis->fault == SIMULATE_FAULT_MISS_STEPS && axis->pulses % axis->fault_every == 0;
}

static void axis_edges(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    simulate_axis_t *axis = state;
    if ((changed & levels & pins_mask(axis->step_gpio)) == 0) {
        return;
    }
    axis->pulses++;
    bool up = ((levels & pins_mask(axis->dir_gpio)) != 0) != axis->dir_inverted;
    axis->last_step_ns = time_ns;
    if (axis->mover != NULL) {
        axis->mover(axis->mover_state, time_ns, up);
        return;
    }
    int64_t next = axis->position_steps + (up ? 1 : -1);
    bool blocked = axis->has_stops && (next < axis->stop_low_steps || next > axis->stop_high_steps);
    if (!is_missed(axis) && !blocked) {
        axis->position_steps = next;
    }
}

bool simulate_axis_attach(simulate_axis_t *axis) {
    return simulate_observe(axis_edges, axis);
}

uint64_t simulate_next_ns(void) {
    uint64_t switch_ns = simulate_switch_next_ns();
    uint64_t driver_ns = simulate_tmc_next_ns();
    return switch_ns < driver_ns ? switch_ns : driver_ns;
}

void simulate_run(uint64_t now_ns) {
    simulate_switch_run(now_ns);
    simulate_tmc_run(now_ns);
    simulate_tmc_wire_run(now_ns);
}
