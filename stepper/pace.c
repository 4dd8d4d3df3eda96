// How a segment goes its way: what is needed once for all axes, and ramps. Context: governor, or
// main with the governor locked.
#include "stepper/pace.h"

void pace_set(pace_t *pace, int32_t due, int32_t change) {
    uint32_t share = UINT32_MAX;
    pace->due = due;
    pace->change = change;
    pace->ticks = 1;
    pace->late = 0;
    if (due > PACE_TICK) {
        share = (uint32_t)(((uint64_t)1 << 48) / (uint32_t)due);
        pace->ticks = (uint32_t)due >> 16;
        pace->late = (uint32_t)due << 16;
    }
    pace->share_high = share >> 16;
    pace->share_low = share & 0xFFFFu;
    uint32_t size = (uint32_t)(change < 0 ? -change : change);
    pace->slope = (uint32_t)(((uint64_t)size * share) >> 30);
    pace->slowing = change < 0;
}

// The upper half of a product; exact would be up to 2 more.
static inline uint32_t multiply_high(uint32_t a, uint32_t b) {
    uint32_t a_low = a & 0xFFFFu;
    uint32_t a_high = a >> 16;
    uint32_t b_low = b & 0xFFFFu;
    uint32_t b_high = b >> 16;
    return a_high * b_high + ((a_high * b_low) >> 16) + ((a_low * b_high) >> 16);
}

uint32_t pace_set_ramp(const pace_t *pace, segment_axis_t *axis, uint32_t mean) {
    uint32_t steps = pace->ticks - 1;
    uint32_t half = multiply_high(mean, pace->slope);
    if (pace->late != 0) {
        uint32_t late = multiply_high(half, pace->late);
        mean = pace->slowing ? mean + late : mean - late;
    }
    uint32_t rise = half * steps;
    if (mean + rise > RATE_MAX) {
        mean = mean < RATE_MAX ? mean : RATE_MAX;
        half = steps > 0 ? (RATE_MAX - mean) / steps : 0;
        rise = half * steps;
    }
    axis->rate = pace->slowing ? mean + rise : mean - rise;
    axis->ramp = pace->slowing ? 0 - 2 * half : 2 * half;
    return mean;
}
