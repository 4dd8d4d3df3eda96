// Simulated switches: pressed by an axis, bouncing, late to open, or made by a driver that notices
// stalls. Context: any.
#include "host_clock.h"
#include "host_pads.h"
#include "simulate.h"

#define SWITCHES_MAX 12u
// Between two bounces.
#define BOUNCE_MIN_NS 4000u
#define BOUNCE_SPREAD_NS 90000u

static struct {
    simulate_switch_t *list[SWITCHES_MAX];
    unsigned count;
} switches;

static uint32_t next_random(simulate_switch_t *limit) {
    limit->random ^= limit->random << 13;
    limit->random ^= limit->random >> 17;
    limit->random ^= limit->random << 5;
    return limit->random;
}

static bool is_pressed(const simulate_switch_t *limit) {
    int64_t at = limit->axis->position_steps;
    int64_t more = limit->pressed ? limit->hysteresis_steps : 0;
    bool pressed = at >= limit->from_steps - more && at <= limit->to_steps + more;
    return limit->fault == SIMULATE_FAULT_NEVER_OPENS ||
           (pressed && limit->fault != SIMULATE_FAULT_NEVER_CLOSES);
}

static void drive(simulate_switch_t *limit, bool closed) {
    limit->closed = closed;
    host_pads_drive(limit->gpio, closed == limit->pressed_level);
}

static void schedule_bounce(simulate_switch_t *limit, uint64_t now_ns) {
    limit->edge_ns = now_ns + BOUNCE_MIN_NS + next_random(limit) % BOUNCE_SPREAD_NS;
}

// The first touch counts, then the contact opens and closes for a while.
static void change(simulate_switch_t *limit, uint64_t now_ns, bool pressed) {
    limit->pressed = pressed;
    drive(limit, pressed);
    if (limit->bounce_us > 0) {
        limit->calm_ns = now_ns + (uint64_t)limit->bounce_us * 1000;
        schedule_bounce(limit, now_ns);
    }
}

static void bounce(simulate_switch_t *limit, uint64_t now_ns) {
    if (now_ns >= limit->calm_ns) {
        limit->edge_ns = 0;
        drive(limit, limit->pressed);
    } else {
        schedule_bounce(limit, now_ns);
        drive(limit, !limit->closed);
    }
}

// A step of the axis at `now_ns`: whether that means a stall follows from the rate.
static void notice_stall(simulate_switch_t *limit, uint64_t now_ns) {
    uint64_t gap_ns = now_ns - limit->last_step_ns;
    bool fast = limit->last_step_ns != 0 && gap_ns * limit->stall_rate_hz <= 1000000000u;
    limit->last_step_ns = now_ns;
    if (fast && is_pressed(limit)) {
        limit->edge_ns = now_ns + (uint64_t)limit->hold_us * 1000;
        drive(limit, true);
    }
}

static void switch_edges(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    simulate_switch_t *limit = state;
    if ((changed & levels & pins_mask(limit->axis->step_gpio)) == 0) {
        return;
    }
    if (limit->stall_rate_hz > 0) {
        notice_stall(limit, time_ns);
    } else if (is_pressed(limit) != limit->pressed) {
        change(limit, time_ns, is_pressed(limit));
    }
}

bool simulate_switch_attach(simulate_switch_t *limit) {
    if (switches.count == SWITCHES_MAX || !simulate_observe(switch_edges, limit)) {
        return false;
    }
    switches.list[switches.count++] = limit;
    limit->random = 0x9E3779B9u ^ (limit->gpio << 8) ^ limit->random;
    limit->pressed = limit->stall_rate_hz == 0 && is_pressed(limit);
    drive(limit, limit->pressed);
    return true;
}

uint64_t simulate_switch_next_ns(void) {
    uint64_t next_ns = HOST_CLOCK_NEVER;
    for (unsigned i = 0; i < switches.count; i++) {
        uint64_t edge_ns = switches.list[i]->edge_ns;
        next_ns = edge_ns != 0 && edge_ns < next_ns ? edge_ns : next_ns;
    }
    return next_ns;
}

void simulate_switch_run(uint64_t now_ns) {
    for (unsigned i = 0; i < switches.count; i++) {
        simulate_switch_t *limit = switches.list[i];
        if (limit->edge_ns == 0 || limit->edge_ns > now_ns) {
            continue;
        }
        if (limit->stall_rate_hz > 0) {
            limit->edge_ns = 0;
            drive(limit, false);
        } else {
            bounce(limit, now_ns);
        }
    }
}
