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

#include <string.h>

segment_ring_t segments;

#define STEP_COMBINATIONS (1u << AXIS_COUNT)

// The compiler has to have `x` in a register here and memory up to date: it neither rewrites the
// arithmetic around it nor mixes what comes before with what comes behind, which on a Cortex-M0+
// takes more registers than there are. Costs nothing by itself.
#define HOLD_VALUE(x) __asm volatile("" : "+r"(x) : : "memory")

// No pin has this number, so it reads 0. In `quiet` it makes the next tick look closely as well: an
// input is suspected, and that it has gone back has to be seen.
#define SUSPICION (1u << 31)

// Inputs whose level has to be there for some samples in a row to count. Noise on one input may
// hold up another one by as many samples, not longer.
typedef struct {
    uint32_t pins;
    uint32_t suspects; // those that had the level in all samples since the first
    int32_t left;      // samples until it is to be decided
    int32_t samples;   // what `left` begins with
} filter_t;

// Written by the tick while it runs. The other contexts read `current` and `ticks_left`, twice, to
// see a pair that belongs together.
static struct {
    segment_t *volatile current;  // NULL: none
    volatile uint32_t ticks_left; // of the current one
    uint32_t raised;              // step pins that are high
    volatile uint32_t watched;    // inputs, and SUSPICION
    volatile uint32_t quiet;      // their levels while nothing is to be done
    hal_pwm_place_t pwm;          // of the spindle
    filter_t trip, latch;
    step_isr_inputs_t inputs;              // what trip.pins are
    uint32_t step_pins[STEP_COMBINATIONS]; // bit 3: X ... bit 0: A, as the carries are gathered
    volatile uint32_t dry_count;
    volatile bool stopped;     // by an input: the tick makes no step until step_isr_abort()
    volatile uint32_t tripped; // the inputs that did it, 0: none

    step_isr_latch_t to_latch;           // what latch.pins are
    volatile uint32_t latch_fired;       // the inputs that did it, 0: none
    segment_t *volatile latched_segment; // where the motors were: NULL, between two motions
    volatile uint32_t latched_left;
    bool latch_collected; // the position is in `latched_steps`
    int32_t latched_steps[AXIS_COUNT];
} isr;

// ---- Inputs -------------------------------------------------------------------------------------

#define RARE(name) __attribute__((noinline)) HAL_RAM_FUNC(name)

// Should somebody start the tick again before the governor has come, it looks closely, finds the
// pin that there is not, and stops.
static inline void keep_stopped(void) {
    isr.inputs.immediate |= SUSPICION;
    isr.quiet = isr.quiet | SUSPICION;
}

static void RARE(stop)(void) {
    isr.stopped = true;
    keep_stopped();
    isr.raised = 0;
    hal_tick_stop();
    hal_governor_request();
}

static void RARE(trip)(uint32_t pins) {
    isr.tripped = isr.tripped | (pins & ~SUSPICION);
    stop();
}

// The suspects have been there for the fewest samples that any input wants. True: the machine is
// stopped.
static bool RARE(decide)(void) {
    uint32_t samples = (uint32_t)(isr.trip.samples - isr.trip.left);
    uint32_t sure = samples >= isr.inputs.limit_samples ? isr.inputs.limits : 0;
    sure |= samples >= isr.inputs.estop_samples ? isr.inputs.estop : 0;
    sure &= isr.trip.suspects;
    if (sure != 0) {
        trip(sure);
    }
    return sure != 0;
}

// Goes on with the suspects of the filter that are still unusual. False if there are none: what is
// unusual now begins its count.
static inline bool go_on(filter_t *filter, uint32_t unusual) {
    uint32_t suspects = unusual & filter->suspects;
    int32_t left = filter->left;
    bool same = suspects != 0;
    if (!same) {
        suspects = unusual & filter->pins;
        left = filter->samples;
    }
    filter->suspects = suspects;
    filter->left = left - 1;
    return same;
}

// Behind the trip's filter, which has had its say about SUSPICION. True: the machine is stopped.
static bool RARE(look_for_latch)(uint32_t unusual) {
    bool same = go_on(&isr.latch, unusual);
    uint32_t suspects = isr.latch.suspects;
    if (suspects == 0) {
        return false;
    }
    if (!same) {
        isr.latched_segment = isr.current;
        isr.latched_left = isr.ticks_left;
    }
    if (isr.latch.left <= 0) {
        isr.watched = isr.watched & ~isr.latch.pins;
        isr.latch.pins = 0;
        isr.latch.suspects = 0;
        isr.latch_fired = suspects;
        if ((suspects & isr.to_latch.halts) != 0) {
            stop();
            return true;
        }
        hal_governor_request();
    } else {
        isr.quiet = isr.quiet | SUSPICION;
    }
    return false;
}

// Some inputs are not as they are while nothing is to be done. True: the machine is stopped.
static inline bool inspect(uint32_t unusual) {
    uint32_t immediate = unusual & isr.inputs.immediate;
    if (immediate != 0) {
        trip(immediate);
        return true;
    }
    if (go_on(&isr.trip, unusual)) {
        if (isr.trip.left <= 0 && decide()) {
            return true;
        }
    } else {
        uint32_t quiet = isr.quiet & ~SUSPICION;
        isr.quiet = isr.trip.suspects != 0 ? quiet | SUSPICION : quiet;
    }
    return isr.latch.pins != 0 && look_for_latch(unusual);
}

// ---- The tick -----------------------------------------------------------------------------------

// Gives the finished segment back and takes the next. Returns its ticks, 0 if there is none.
static uint32_t HAL_RAM_FUNC(next_segment)(void) {
    const segment_t *finished = isr.current;
    if (finished != NULL) {
        ring_take(&segments.ring);
        hal_governor_request();
    }
    if (ring_used(&segments.ring) == 0) {
        isr.current = NULL;
        isr.raised = 0;
        bool dry = finished != NULL && (finished->flags & SEGMENT_MAY_END) == 0;
        isr.dry_count = isr.dry_count + dry;
        if (isr.watched == SUSPICION) {
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
    uint32_t unusual = (hal_pins_read() ^ isr.quiet) & isr.watched;
    if (__builtin_expect(unusual != 0, 0) && inspect(unusual)) {
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

void step_isr_setup(void) {
    isr.inputs = (step_isr_inputs_t){0};
    isr.trip = isr.latch = (filter_t){0};
    isr.watched = SUSPICION;
    isr.quiet = 0;
    isr.latch_fired = 0;
    isr.stopped = false;
    isr.tripped = 0;
    isr.current = NULL;
    isr.ticks_left = 0;
    isr.raised = 0;
    isr.dry_count = 0;
    ring_reset(&segments.ring, SEGMENTS);
}

// In this order the tick may come between any two of these lines: a pin that stays in goes on being
// watched, one that is new has its level first, and a count that is under way begins anew. Should a
// latch leave its note meanwhile, its pins must not come back; should the tick stop itself, it has
// to stay so.
static void watch(void) {
    uint32_t latch;
    do {
        latch = isr.latch.pins;
        uint32_t trips = isr.inputs.estop | isr.inputs.limits;
        uint32_t watched = trips | latch | SUSPICION;
        isr.watched = isr.watched & watched;
        isr.trip.pins = trips;
        RING_BARRIER();
        isr.quiet = (~isr.inputs.levels & trips) | (~isr.to_latch.levels & latch);
        isr.watched = watched;
        RING_BARRIER();
        isr.trip.suspects = 0;
        if (isr.stopped) {
            keep_stopped();
        }
    } while (latch != isr.latch.pins);
}

void step_isr_watch(const step_isr_inputs_t *inputs) {
    step_isr_inputs_t with_immediate = *inputs;
    with_immediate.immediate = inputs->estop_samples <= 1 ? inputs->estop : 0;
    with_immediate.immediate |= inputs->limit_samples <= 1 ? inputs->limits : 0;
    uint32_t fewest = inputs->limit_samples;
    if (inputs->estop_samples > 1 && inputs->estop_samples < fewest) {
        fewest = inputs->estop_samples;
    }
    isr.watched = isr.watched & (inputs->estop | isr.latch.pins | SUSPICION);
    RING_BARRIER();
    isr.inputs = with_immediate;
    RING_BARRIER();
    isr.trip.samples = (int32_t)fewest;
    watch();
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

bool step_isr_position(int32_t steps[AXIS_COUNT]) {
    for (;;) {
        const segment_t *segment = isr.current;
        uint32_t left = isr.ticks_left;
        uint32_t taken = segments.ring.read;
        RING_BARRIER();
        bool waiting = segment == NULL && ring_used(&segments.ring) > 0;
        if (segment != NULL) {
            segment_position(segment, left, left, steps);
        } else if (waiting) { // the first tick is still to come
            segment_start(&segments.slots[segments.ring.take_slot], steps);
        }
        RING_BARRIER();
        if (segment == isr.current && left == isr.ticks_left && taken == segments.ring.read) {
            return segment != NULL || waiting;
        }
    }
}

// ---- Latch --------------------------------------------------------------------------------------

void step_isr_latch_arm(const step_isr_latch_t *latch) {
    step_isr_latch_disarm();
    isr.to_latch = *latch;
    isr.latch.samples = (int32_t)latch->samples;
    isr.latch.suspects = 0;
    isr.latch.pins = latch->pins;
    watch();
    hal_tick_start();
}

void step_isr_latch_disarm(void) {
    isr.watched = isr.watched & ~isr.latch.pins;
    RING_BARRIER();
    isr.latch.pins = 0;
    isr.latch_fired = 0;
    isr.latch_collected = false;
    watch();
}

uint32_t step_isr_latch_reserve(void) {
    if (step_isr_latch_waits()) {
        return SEGMENTS;
    }
    return isr.latch.pins != 0 ? (uint32_t)isr.latch.samples + 1 : 0;
}

bool step_isr_latch_waits(void) {
    return isr.latch_fired != 0 && !isr.latch_collected;
}

// Between two motions: where the next one begins, which may be under way.
static bool collect_at_rest(void) {
    bool known = ring_used(&segments.ring) > 0;
    if (known) {
        segment_start(&segments.slots[segments.ring.take_slot], isr.latched_steps);
    }
    return known;
}

// As long as it was in the segment of the first sample; the slot is untouched until now
// (step_isr_latch_reserve).
static void collect_in(const segment_t *segment) {
    uint32_t left;
    do {
        left = segment == isr.current ? isr.ticks_left : 0;
        RING_BARRIER();
        segment_position(segment, left, isr.latched_left, isr.latched_steps);
        RING_BARRIER();
    } while (left != (segment == isr.current ? isr.ticks_left : 0));
}

bool step_isr_latch_collect(void) {
    if (!step_isr_latch_waits()) {
        return true;
    }
    isr.latch_collected = true;
    if (isr.latched_segment != NULL) {
        collect_in(isr.latched_segment);
    } else {
        isr.latch_collected = collect_at_rest();
    }
    return isr.latch_collected;
}

void step_isr_latch_stand(const int32_t steps[AXIS_COUNT]) {
    memcpy(isr.latched_steps, steps, sizeof isr.latched_steps);
    isr.latch_collected = true;
}

bool step_isr_latched(int32_t steps[AXIS_COUNT], uint32_t *pins) {
    *pins = isr.latch_fired;
    memcpy(steps, isr.latched_steps, sizeof isr.latched_steps);
    return isr.latch_collected;
}

// ---- Stops --------------------------------------------------------------------------------------

bool step_isr_halt(void) {
    hal_tick_stop();
    hal_pins_clear(isr.raised);
    isr.raised = 0;
    uint32_t rates = 0;
    for (axis_id_t axis = 0; isr.current != NULL && axis < AXIS_COUNT; axis++) {
        rates |= isr.current->axes[axis].rate;
    }
    return rates != 0;
}

void step_isr_abort(void) {
    step_isr_halt();
    isr.current = NULL;
    isr.ticks_left = 0;
    ring_reset(&segments.ring, SEGMENTS);
    isr.stopped = false;
    isr.inputs.immediate &= ~SUSPICION;
}

uint32_t step_isr_tripped(void) {
    return isr.tripped;
}

bool step_isr_stopped(void) {
    return isr.stopped;
}

void step_isr_rearm(void) {
    isr.tripped = 0;
}

bool step_isr_watches(void) {
    return isr.watched != SUSPICION;
}

uint32_t step_isr_dry_count(void) {
    return isr.dry_count;
}
