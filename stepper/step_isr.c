// The tick, 100 kHz, highest priority, in RAM: integers only, no division, no call into flash.
//
// Each axis is an accumulator of its own: phase += rate, and a carry out of 32 bits is a step. So a
// slow axis is as evenly timed as a fast one, and with rate <= 2^31 there is always a tick without
// a step between two steps, in which the pin goes low. The rate changes in each tick as well (rate
// += ramp), so that speeds are ramps and not stairs. The governor knows phase, rate and ramp
// exactly and therefore the number of steps in a segment; nothing needs to be counted here. Where
// the motors are in the middle of a segment follows from the ticks that are done
// (step_isr_position).
#include "stepper/step_isr.h"

segment_ring_t segments;

#define STEP_COMBINATIONS (1u << AXIS_COUNT)

// The compiler has to have `x` in a register here and memory up to date: it neither rewrites the
// arithmetic around it nor mixes what comes before with what comes behind, which on a Cortex-M0+
// takes more registers than there are. Costs nothing by itself.
#define HOLD_VALUE(x) __asm volatile("" : "+r"(x) : : "memory")

// Written by the tick while it runs. The other contexts read `current` and `ticks_left`, twice, to
// see a pair that belongs together.
static struct {
    segment_t *volatile current;           // NULL: none
    volatile uint32_t ticks_left;          // of the current one
    uint32_t raised;                       // step pins that are high
    uint32_t trip_mask;                    // safety inputs
    uint32_t trip_idle;                    // their levels while all is well
    hal_pwm_place_t pwm;                   // of the spindle
    uint32_t step_pins[STEP_COMBINATIONS]; // bit 3: X ... bit 0: A, as the carries are gathered
    volatile uint32_t dry_count;
    volatile bool tripped;
} isr;

static void HAL_RAM_FUNC(trip)(void) {
    isr.tripped = true;
    isr.raised = 0;
    hal_tick_stop();
    hal_governor_request();
}

// Gives the finished segment back and takes the next. Returns its ticks, 0 if there is none.
static uint32_t HAL_RAM_FUNC(next_segment)(void) {
    bool dry = false;
    if (isr.current != NULL) {
        dry = (isr.current->flags & SEGMENT_MAY_END) == 0;
        isr.current = NULL;
        ring_take(&segments.ring);
        hal_governor_request();
    }
    if (ring_used(&segments.ring) == 0) {
        isr.raised = 0;
        isr.dry_count = isr.dry_count + dry;
        if (isr.trip_mask == 0) {
            hal_tick_stop();
        }
        return 0;
    }
    segment_t *segment = &segments.slots[segments.ring.take_slot];
    hal_pins_set(segment->pins_set);
    hal_pins_clear(segment->pins_clear);
    hal_pwm_level(isr.pwm, (uint16_t)(segment->flags >> SEGMENT_LEVEL_SHIFT));
    isr.current = segment;
    return segment->ticks;
}

// One tick of an axis. Returns twice `steps`, minus one if the axis makes a step.
static inline uint32_t advance_axis(segment_axis_t *axis, uint32_t steps) {
    uint32_t rate = axis->rate;
    uint32_t phase = axis->phase + rate;
    uint32_t next_rate = rate + axis->ramp;
    axis->phase = phase;
    axis->rate = next_rate;
    uint32_t carry = 0u - (uint32_t)(phase < rate); // two instructions, if left like this
    HOLD_VALUE(carry);
    return steps + steps + carry;
}

void HAL_RAM_FUNC(hal_on_tick)(void) {
    hal_pins_clear(isr.raised);
    if (((hal_pins_read() ^ isr.trip_idle) & isr.trip_mask) != 0) {
        trip();
        return;
    }
    uint32_t left = isr.ticks_left;
    if (left == 0) {
        left = next_segment();
        if (left == 0) {
            return;
        }
    }
    isr.ticks_left = left - 1;

    segment_t *segment = isr.current;
    uint32_t steps = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps = advance_axis(&segment->axes[axis], steps);
    }
    uint32_t pins = isr.step_pins[0u - steps];
    hal_pins_set(pins);
    isr.raised = pins;
}

void step_isr_setup(uint32_t trip_mask, uint32_t trip_levels) {
    isr.trip_mask = trip_mask;
    isr.trip_idle = ~trip_levels & trip_mask;
    isr.tripped = false;
    isr.current = NULL;
    isr.ticks_left = 0;
    isr.raised = 0;
    isr.dry_count = 0;
    ring_reset(&segments.ring, SEGMENTS);
}

void step_isr_set_pins(const uint32_t masks[AXIS_COUNT]) {
    for (unsigned steps = 0; steps < STEP_COMBINATIONS; steps++) {
        uint32_t pins = 0;
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            pins |= (steps >> (AXIS_COUNT - 1 - axis)) & 1 ? masks[axis] : 0;
        }
        isr.step_pins[steps] = pins;
    }
}

void step_isr_set_pwm(hal_pwm_place_t place) {
    isr.pwm = place;
}

// Motor position at `left` ticks before the end of `segment`: phase and rate at its start follow
// from those now, and the carries since then from 64-bit arithmetic.
static void position_in(const segment_t *segment, uint32_t left, int32_t steps[AXIS_COUNT]) {
    uint64_t done = segment->ticks - left;
    uint64_t ramps = done * (done - 1) / 2; // 0 + 1 + ... + (done - 1): how often each ramp counts
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        const segment_axis_t *now = &segment->axes[axis];
        uint32_t start_rate = now->rate - now->ramp * (uint32_t)done;
        uint64_t travel = start_rate * done + (uint64_t)(int32_t)now->ramp * ramps;
        uint32_t start_phase = now->phase - (uint32_t)travel;
        int32_t carries = (int32_t)((start_phase + travel) >> 32);
        bool negative = (segment->flags >> axis) & 1;
        steps[axis] = now->start_steps + (negative ? -carries : carries);
    }
}

bool step_isr_position(int32_t steps[AXIS_COUNT]) {
    for (;;) {
        const segment_t *segment = isr.current;
        uint32_t left = isr.ticks_left;
        uint32_t taken = segments.ring.read;
        RING_BARRIER();
        bool waiting = segment == NULL && ring_used(&segments.ring) > 0;
        if (segment != NULL) {
            position_in(segment, left, steps);
        } else if (waiting) { // the first tick is still to come
            const segment_t *first = &segments.slots[segments.ring.take_slot];
            for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
                steps[axis] = first->axes[axis].start_steps;
            }
        }
        RING_BARRIER();
        if (segment == isr.current && left == isr.ticks_left && taken == segments.ring.read) {
            return segment != NULL || waiting;
        }
    }
}

void step_isr_abort(void) {
    hal_tick_stop();
    hal_pins_clear(isr.raised);
    isr.raised = 0;
    isr.current = NULL;
    isr.ticks_left = 0;
    ring_reset(&segments.ring, SEGMENTS);
}

bool step_isr_tripped(void) {
    return isr.tripped;
}

void step_isr_rearm(void) {
    isr.tripped = false;
}

bool step_isr_watches(void) {
    return isr.trip_mask != 0;
}

uint32_t step_isr_dry_count(void) {
    return isr.dry_count;
}
