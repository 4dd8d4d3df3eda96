// How a segment goes its way: from a way and the time for it to a rate and how it changes. Inside
// stepper/ only; what each axis of each segment needs is inline. Context: governor, or main with
// the governor locked.
//
// Within a segment of n ticks the rate rises evenly around its mean:
//
//   rate |          .-+     first = mean - half * (n - 1)
//        |      .-+-'       ramp  = 2 * half
//   mean |- - +-' - - -     last  = mean + half * (n - 1)
//        |.-+-'             way   = mean * n, exactly
//        +-+-+-+-+-+-+-> ticks
#ifndef STEPPER_PACE_H
#define STEPPER_PACE_H

#include "stepper/segment.h"

#define PACE_TICK ((int32_t)1 << 16) // times in 2^-16 ticks

typedef struct {
    uint32_t ticks;                 // of the segment
    uint32_t share_high, share_low; // of the way in a tick, 2^-16 and 2^-32
    uint32_t slope; // change of the rate in half a tick as a part of the mean rate, 2^-32
    uint32_t late;  // 2^-32 ticks that the way goes on behind the segment
    bool slowing;
    int32_t due, change; // what it was made for; `due` < 0: nothing yet
} pace_t;

// For a way that is `due` (times as above) and on which the speed along the path changes by
// `change`, as segment_writer_move() has it.
void pace_set(pace_t *pace, int32_t due, int32_t change);

static inline bool pace_is_for(const pace_t *pace, int32_t due, int32_t change) {
    return due == pace->due && change == pace->change;
}

// The rate with which `way` (> 0) is done in the time of the pace; too fast ones are limited.
static inline uint32_t pace_mean_rate(const pace_t *pace, int64_t way) {
    uint32_t steps = (uint32_t)(way >> 32);
    uint32_t low = (uint32_t)way & 0xFFFFu;
    uint32_t high = (uint32_t)way >> 16;
    if (steps > pace->ticks / 2) {
        return RATE_MAX;
    }
    uint32_t share = pace->share_high << 16 | pace->share_low;
    uint32_t rate = steps * share + high * pace->share_high + ((high * pace->share_low) >> 16) +
                    ((low * pace->share_high) >> 16);
    return rate < RATE_MAX ? rate : RATE_MAX;
}

// The whole product of a rate and less than 2^16 ticks.
static inline int64_t pace_way(uint32_t rate, uint32_t ticks) {
    uint32_t high = (rate >> 16) * ticks + (((rate & 0xFFFFu) * ticks) >> 16);
    return (int64_t)((uint64_t)(high >> 16) << 32 | rate * ticks);
}

// Makes the rate rise or fall evenly. Returns its mean over the segment, given that over the way.
uint32_t pace_set_ramp(const pace_t *pace, segment_axis_t *axis, uint32_t mean);

#endif
