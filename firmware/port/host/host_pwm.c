// Levels and edges of PWM slices, from their settings and the time. Context: any.
#include "host_pwm.h"

#include "hal/hal.h"
#include "host_clock.h"
#include "host_trace.h"

#define CLOCK_HZ 125000000u // as on a Pico: half a nanosecond for each 16th of a cycle

static struct {
    hal_pwm_t pwm;
    bool running;
    uint64_t start_ns;    // when the counter was `start_count`
    uint32_t start_count; // within a period, which takes twice top + 1 counts if phase correct
} slices[HAL_PWM_SLICES];

static uint32_t pins;
static uint32_t shown;       // levels as the trace has them
static uint64_t recorded_ns; // the trace is complete up to here

uint32_t hal_clock_hz(void) {
    return CLOCK_HZ;
}

// ---- One slice ----------------------------------------------------------------------------------

static uint32_t period_of(unsigned slice) {
    return (slices[slice].pwm.top + 1u) * (slices[slice].pwm.phase_correct ? 2u : 1u);
}

// Counts since the counter was last 0 before the start.
static uint64_t counts_at(unsigned slice, uint64_t time_ns) {
    if (!slices[slice].running) {
        return slices[slice].start_count;
    }
    uint64_t counts = (time_ns - slices[slice].start_ns) * 2 / slices[slice].pwm.divider_16ths;
    return slices[slice].start_count + counts;
}

static uint64_t time_of(unsigned slice, uint64_t counts) {
    uint64_t half_ns = (counts - slices[slice].start_count) * slices[slice].pwm.divider_16ths;
    return slices[slice].start_ns + (half_ns + 1) / 2;
}

static bool level_of(unsigned gpio, uint64_t time_ns) {
    unsigned slice = HAL_PWM_SLICE(gpio);
    const hal_pwm_t *pwm = &slices[slice].pwm;
    uint32_t place = (uint32_t)(counts_at(slice, time_ns) % period_of(slice));
    uint32_t counter = place <= pwm->top ? place : 2u * pwm->top + 1u - place;
    bool high = counter < pwm->level[HAL_PWM_CHANNEL(gpio)];
    return high != pwm->inverted[HAL_PWM_CHANNEL(gpio)];
}

// When the output of a pin changes next, behind `time_ns`.
static uint64_t next_edge_ns(unsigned gpio, uint64_t time_ns) {
    unsigned slice = HAL_PWM_SLICE(gpio);
    const hal_pwm_t *pwm = &slices[slice].pwm;
    uint32_t level = pwm->level[HAL_PWM_CHANNEL(gpio)];
    if (!slices[slice].running || level == 0 || level > pwm->top) {
        return HOST_CLOCK_NEVER;
    }
    uint32_t period = period_of(slice);
    uint64_t counts = counts_at(slice, time_ns);
    uint64_t begin = counts - counts % period;
    uint64_t up = begin + (pwm->phase_correct ? period - level : period);
    uint64_t down = begin + level;
    uint64_t next = counts < down ? down : counts < up ? up : begin + period + level;
    return time_of(slice, next);
}

// ---- The trace ----------------------------------------------------------------------------------

static void show(uint64_t time_ns, uint32_t mask) {
    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        unsigned gpio = (unsigned)__builtin_ctz(rest);
        bool level = level_of(gpio, time_ns);
        if (level != ((shown >> gpio & 1u) != 0)) {
            shown ^= 1u << gpio;
            host_trace_row(time_ns, gpio, level);
        }
    }
}

void host_pwm_record(uint64_t until_ns) {
    while (pins != 0) {
        uint64_t next_ns = HOST_CLOCK_NEVER;
        for (uint32_t rest = pins; rest != 0; rest &= rest - 1) {
            uint64_t edge_ns = next_edge_ns((unsigned)__builtin_ctz(rest), recorded_ns);
            next_ns = edge_ns < next_ns ? edge_ns : next_ns;
        }
        if (next_ns > until_ns) {
            break;
        }
        show(next_ns, pins);
        recorded_ns = next_ns;
    }
    recorded_ns = until_ns;
}

// Brings the trace up to date before a slice changes, and shows what came of it afterwards.
static void before_change(void) {
    if (host_trace_is_open()) {
        host_pwm_record(host_clock_now_ns());
    }
    recorded_ns = host_clock_now_ns();
}

static void after_change(void) {
    show(host_clock_now_ns(), pins);
}

// ---- Pins ---------------------------------------------------------------------------------------

void host_pwm_add(unsigned gpio) {
    before_change();
    pins |= pins_mask(gpio);
    after_change();
}

void host_pwm_remove(unsigned gpio) {
    if ((pins & pins_mask(gpio)) == 0) {
        return;
    }
    before_change();
    if ((shown & pins_mask(gpio)) != 0) {
        host_trace_row(host_clock_now_ns(), gpio, false);
    }
    shown &= ~pins_mask(gpio);
    pins &= ~pins_mask(gpio);
}

uint32_t host_pwm_pins(void) {
    return pins;
}

uint32_t host_pwm_levels(void) {
    uint32_t levels = 0;
    for (uint32_t rest = pins; rest != 0; rest &= rest - 1) {
        unsigned gpio = (unsigned)__builtin_ctz(rest);
        levels |= level_of(gpio, host_clock_now_ns()) ? 1u << gpio : 0;
    }
    return levels;
}

const hal_pwm_t *host_pwm_settings(unsigned slice) {
    return &slices[slice].pwm;
}

// ---- The seam -----------------------------------------------------------------------------------

// The counter goes on from where it stands, or from 0 if that is beyond the new top.
static void anchor(unsigned slice) {
    uint32_t place = (uint32_t)(counts_at(slice, host_clock_now_ns()) % period_of(slice));
    slices[slice].start_count = place;
    slices[slice].start_ns = host_clock_now_ns();
}

void hal_pwm_set(unsigned slice, const hal_pwm_t *pwm) {
    before_change();
    if (slices[slice].running) {
        anchor(slice);
    }
    slices[slice].pwm = *pwm;
    if (slices[slice].start_count >= period_of(slice)) {
        slices[slice].start_count = 0;
    }
    after_change();
}

hal_pwm_place_t hal_pwm_place(unsigned slice) {
    return slice;
}

void hal_pwm_level(hal_pwm_place_t slice, uint16_t level) {
    if (slice >= HAL_PWM_SLICES ||
        (slices[slice].pwm.level[0] == level && slices[slice].pwm.level[1] == level)) {
        return;
    }
    hal_pwm_t pwm = slices[slice].pwm;
    pwm.level[0] = pwm.level[1] = level;
    hal_pwm_set(slice, &pwm);
}

void hal_pwm_start(uint32_t mask, const uint16_t counts[HAL_PWM_SLICES]) {
    before_change();
    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        unsigned slice = (unsigned)__builtin_ctz(rest);
        slices[slice].running = true;
        slices[slice].start_ns = host_clock_now_ns();
        slices[slice].start_count = counts[slice];
    }
    after_change();
}

void hal_pwm_stop(unsigned slice) {
    before_change();
    slices[slice].running = false;
    slices[slice].start_count = 0;
    after_change();
}
