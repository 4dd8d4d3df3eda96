// From positions and times to phases, rates and ramps.
//
// The exact position of each axis is kept in 2^-32 of a step and moves by the sum of the rates of
// each segment, nothing else; whatever rounding leaves over stays in the distance to the next
// target. The motor stands at the nearest whole step: floor(position + 1/2). Hence the phase, which
// is the fraction of position + 1/2, counts up to the next step; for a direction down it is
// mirrored.
//
// Within a segment of n ticks the rate rises evenly around its mean:
//
//   rate |          .-+     first = mean - half * (n - 1)
//        |      .-+-'       ramp  = 2 * half
//   mean |- - +-' - - -     last  = mean + half * (n - 1)
//        |.-+-'             way   = mean * n, exactly
//        +-+-+-+-+-+-+-> ticks
//
// A target is where the path is at a time that may lie between two ticks. The segment ends at the
// last tick before, with the rate of the path, and the rest of the way has the rest of the time.
#include "stepper/segment_writer.h"

#include "stepper/step_isr.h"

#define HALF_STEP (STEP_ONE / 2)
// Distances below this are rounding, not motion: 1/4096 of a step. They must not turn an axis
// round.
#define NO_DISTANCE ((int64_t)1 << 20)
#define TICK_ONE ((int32_t)1 << 16)    // times in 2^-16 ticks
#define AXES ((1u << AXIS_COUNT) - 1u) // of the flags of a segment
#define ROOM 4                         // segments: one call writes up to that many
// What is rare stays out of the quick way, which has too few registers on a Cortex-M0+ as it is.
#define SEPARATE __attribute__((noinline))

// How a segment goes its way.
typedef struct {
    uint32_t ticks;                 // of the segment
    uint32_t share_high, share_low; // of the way in a tick, 2^-16 and 2^-32
    uint32_t slope; // change of the rate in half a tick as a part of the mean rate, 2^-32
    uint32_t late;  // 2^-32 ticks that the way goes on behind the segment
    bool slowing;
    int32_t due, change; // what it was made for
} pace_t;

typedef struct {
    int64_t place;      // 2^-32 steps, end of the last segment
    uint32_t last_rate; // in its last tick
    uint32_t dir;       // pin mask
} writer_axis_t;

static struct {
    writer_axis_t axes[AXIS_COUNT];
    uint32_t flags; // of segments: bit n: axis n counts down; upper half: level of the PWM
    uint32_t dir_inverted;
    int32_t late; // 2^-16 ticks by which the segments end before the times they should have had
    uint32_t end_ticks;
    uint32_t unpublished; // slots that are filled
    pace_t paces[2];      // the last two; at a steady speed slices of two lengths take turns
    uint32_t recent;      // which of them is the last one
} writer = {.paces = {{.due = -1}, {.due = -1}}}; // made for nothing yet

// Segments that were dropped may have been about to turn an axis round, so the pins have the last
// word.
static void follow_dir_pins(void) {
    uint32_t pins = hal_pins_read();
    writer.flags &= ~AXES;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        uint32_t dir = writer.axes[axis].dir;
        uint32_t low = (pins & dir) != 0 ? 0 : 1u << axis;
        writer.flags |= dir != 0 ? low ^ (writer.dir_inverted & 1u << axis) : 0;
    }
}

static void stand_at(const int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        writer.axes[axis].place = steps[axis] * STEP_ONE;
        writer.axes[axis].last_rate = 0;
    }
    writer.late = 0;
}

void segment_writer_reset(const int32_t steps[AXIS_COUNT]) {
    follow_dir_pins();
    stand_at(steps);
}

void segment_writer_set_dir_pins(const uint32_t dir[AXIS_COUNT], uint32_t inverted) {
    writer.dir_inverted = inverted;
    writer.flags &= ~AXES;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        writer.axes[axis].dir = dir[axis];
        bool low = (inverted >> axis) & 1;
        hal_pins_set(low ? 0 : dir[axis]);
        hal_pins_clear(low ? dir[axis] : 0);
    }
}

void segment_writer_set_level(uint16_t level) {
    writer.flags = (writer.flags & UINT16_MAX) | (uint32_t)level << SEGMENT_LEVEL_SHIFT;
}

uint16_t segment_writer_level(void) {
    return (uint16_t)(writer.flags >> SEGMENT_LEVEL_SHIFT);
}

void segment_writer_end_steps(int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = (int32_t)((writer.axes[axis].place + HALF_STEP) >> 32);
    }
}

void segment_writer_settle(void) {
    int32_t steps[AXIS_COUNT];
    segment_writer_end_steps(steps);
    stand_at(steps);
}

uint32_t segment_writer_spare_ticks(void) {
    if (ring_used(&segments.ring) + writer.unpublished == 0) {
        return 0;
    }
    const segment_t *oldest = &segments.slots[segments.ring.take_slot];
    return writer.end_ticks - oldest->end_ticks;
}

uint32_t segment_writer_oldest_ticks(void) {
    if (ring_used(&segments.ring) + writer.unpublished == 0) {
        return 0;
    }
    return segments.slots[segments.ring.take_slot].ticks;
}

bool segment_writer_has_room(void) {
    return ring_free(&segments.ring) >= writer.unpublished + ROOM + step_isr_latch_reserve();
}

// ---- One segment --------------------------------------------------------------------------------

// The upper half of a product; exact would be up to 2 more.
static inline uint32_t multiply_high(uint32_t a, uint32_t b) {
    uint32_t a_low = a & 0xFFFFu;
    uint32_t a_high = a >> 16;
    uint32_t b_low = b & 0xFFFFu;
    uint32_t b_high = b >> 16;
    return a_high * b_high + ((a_high * b_low) >> 16) + ((a_low * b_high) >> 16);
}

// The whole product of a rate and less than 2^16 ticks.
static inline int64_t way_of(uint32_t rate, uint32_t ticks) {
    uint32_t high = (rate >> 16) * ticks + (((rate & 0xFFFFu) * ticks) >> 16);
    return (int64_t)((uint64_t)(high >> 16) << 32 | rate * ticks);
}

static inline segment_t *open_slot(void) {
    return &segments.slots[segments.ring.put_slot];
}

static inline bool counts_down(axis_id_t axis) {
    return (writer.flags >> axis) & 1;
}

// The fraction of `place` + 1/2 in the direction of the axis.
static inline uint32_t phase_at(int64_t place, bool down) {
    uint32_t phase = (uint32_t)place ^ (uint32_t)HALF_STEP;
    return down ? ~phase : phase;
}

// The rate with which `way` (> 0) is done in the time of the pace; too fast ones are limited.
static inline uint32_t mean_rate(int64_t way, const pace_t *pace) {
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

// Makes the rate rise or fall evenly. Returns its mean over the segment, given that over the way.
SEPARATE static uint32_t set_ramp(segment_axis_t *axis, uint32_t mean, const pace_t *pace) {
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

// Fills the next slot, unpublished, and moves on. Axes that would have to turn round for it stand;
// returns them.
static uint32_t write_segment(const int64_t target[AXIS_COUNT], const pace_t *pace) {
    segment_t *segment = open_slot();
    segment->ticks = pace->ticks;
    segment->pins_set = 0;
    segment->pins_clear = 0;
    uint32_t flags = writer.flags;
    segment->flags = flags;
    uint32_t turning = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        writer_axis_t *from = &writer.axes[axis];
        segment_axis_t *out = &segment->axes[axis];
        int64_t place = from->place;
        bool down = (flags >> axis) & 1;
        out->start_steps = (int32_t)((place + HALF_STEP) >> 32);
        out->phase = phase_at(place, down);
        int64_t way = down ? place - target[axis] : target[axis] - place;
        if (way <= 0) {
            out->rate = 0;
            out->ramp = 0;
            if (way <= -NO_DISTANCE) {
                turning |= 1u << axis;
            } else {
                from->last_rate = 0;
            }
            continue;
        }
        uint32_t mean = mean_rate(way, pace);
        out->rate = mean;
        out->ramp = 0;
        from->last_rate = mean;
        if (pace->slope != 0) {
            mean = set_ramp(out, mean, pace);
            from->last_rate = 2 * mean - out->rate;
        }
        int64_t moved = way_of(mean, pace->ticks);
        from->place = down ? place - moved : place + moved;
    }
    return turning;
}

static void close_slot(void) {
    segment_t *segment = open_slot();
    writer.end_ticks += segment->ticks;
    segment->end_ticks = writer.end_ticks;
    ring_fill(&segments.ring);
    writer.unpublished++;
}

void segment_writer_publish(void) {
    ring_publish(&segments.ring, writer.unpublished);
    writer.unpublished = 0;
}

// Shortens the segment in the open slot to `ticks`, 0 or 1, with the axes of `standing` at rest.
static void shorten(uint32_t ticks, uint32_t standing) {
    segment_t *segment = open_slot();
    segment->ticks = ticks;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        segment_axis_t *out = &segment->axes[axis];
        if ((standing >> axis) & 1) {
            out->rate = 0;
            out->ramp = 0;
        }
        bool down = counts_down(axis);
        int64_t start = out->start_steps * STEP_ONE + (down ? ~out->phase : out->phase) - HALF_STEP;
        int64_t moved = (int64_t)out->rate * ticks;
        writer.axes[axis].place = down ? start - moved : start + moved;
        writer.axes[axis].last_rate = ticks == 0 ? writer.axes[axis].last_rate : out->rate;
    }
}

// ---- A way --------------------------------------------------------------------------------------

// What is still to go.
typedef struct {
    const int64_t *target;
    int32_t due;    // 2^-16 ticks
    int32_t change; // of the path's speed on the way
} way_t;

SEPARATE static void set_pace(pace_t *pace, int32_t due, int32_t change) {
    uint32_t share = UINT32_MAX;
    pace->due = due;
    pace->change = change;
    pace->ticks = 1;
    pace->late = 0;
    if (due > TICK_ONE) {
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

static inline bool is_for(const pace_t *pace, const way_t *way) {
    return way->due == pace->due && way->change == pace->change;
}

static inline uint32_t go(const way_t *way) {
    pace_t *pace = &writer.paces[writer.recent];
    if (!is_for(pace, way)) {
        writer.recent ^= 1;
        pace = &writer.paces[writer.recent];
        if (!is_for(pace, way)) {
            set_pace(pace, way->due, way->change);
        }
    }
    return write_segment(way->target, pace);
}

// Goes only one tick of what is in the open slot. `standing`: axes that do not take part.
static void go_one_tick(way_t *way, uint32_t standing) {
    shorten(1, standing);
    close_slot();
    if (way->due >= 2 * TICK_ONE) {
        // With the mean speed as 1, a tick of the way from 1 - change to 1 + change is done.
        int32_t done = TICK_ONE + way->change / (SEGMENT_CHANGE_ONE / TICK_ONE);
        way->due -= TICK_ONE;
        uint32_t size = (uint32_t)(way->change < 0 ? -way->change : way->change);
        size = (uint32_t)((uint64_t)size * (uint32_t)way->due / (uint32_t)(way->due + done));
        way->change = way->change < 0 ? -(int32_t)size : (int32_t)size;
    }
}

// Those of the axes that made a step in the very last tick.
static uint32_t just_stepped(uint32_t axes) {
    uint32_t stepped = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        const writer_axis_t *from = &writer.axes[axis];
        uint32_t phase = phase_at(from->place, counts_down(axis));
        stepped |= phase < from->last_rate ? axes & 1u << axis : 0;
    }
    return stepped;
}

// Those of the axes that make a step in the first tick of the open slot.
static uint32_t about_to_step(uint32_t axes) {
    uint32_t stepping = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        const segment_axis_t *out = &open_slot()->axes[axis];
        stepping |= out->phase + out->rate < out->rate ? axes & 1u << axis : 0;
    }
    return stepping;
}

static void switch_directions(uint32_t turning) {
    segment_t *segment = open_slot();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((turning >> axis) & 1) {
            bool high = (((writer.flags ^ writer.dir_inverted) >> axis) & 1) == 0;
            uint32_t dir = writer.axes[axis].dir;
            segment->pins_set |= high ? dir : 0;
            segment->pins_clear |= high ? 0 : dir;
        }
    }
}

// Lets axes turn round that stand in the open slot. The direction pin changes at least a tick
// behind the last pulse's end and a tick ahead of the next pulse: an axis that has just made a
// step, or is about to, stands for a tick. Near standstill, where axes turn as a rule, that is not
// the case.
SEPARATE static void turn(way_t *way, uint32_t turning) {
    if (just_stepped(turning) != 0) {
        go_one_tick(way, turning);
    } else {
        shorten(0, turning);
    }
    writer.flags ^= turning;
    go(way);
    switch_directions(turning);
    uint32_t stepping = about_to_step(turning);
    if (stepping != 0) {
        go_one_tick(way, stepping);
        go(way);
    }
}

// The motion is to end with what is in the open slot. Where the end of the way lies between two
// ticks, or the limit of the rate has left something over, the rest follows as fast as possible.
SEPARATE static void arrive(const int64_t target[AXIS_COUNT]) {
    int64_t farthest = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t left = target[axis] - writer.axes[axis].place;
        left = counts_down(axis) ? -left : left;
        farthest = left > farthest ? left : farthest;
    }
    if (farthest >= NO_DISTANCE) {
        int32_t ticks = (int32_t)(((uint64_t)farthest + RATE_MAX - 1) / RATE_MAX);
        close_slot();
        go(&(way_t){.target = target, .due = ticks * TICK_ONE});
    }
    open_slot()->flags |= SEGMENT_MAY_END;
    writer.late = 0;
}

void segment_writer_move(const int64_t target[AXIS_COUNT], float ticks, int32_t change,
                         bool at_rest) {
    int32_t due = (int32_t)(uint32_t)(ticks * (float)TICK_ONE) + writer.late;
    if (due < TICK_ONE && !at_rest) {
        writer.late = due; // less than a tick: the next one goes this way, too
        return;
    }
    way_t way = {.target = target, .due = due, .change = change};
    uint32_t turning = go(&way);
    if (turning != 0) {
        turn(&way, turning);
    }
    writer.late = way.due - (int32_t)open_slot()->ticks * TICK_ONE;
    if (at_rest) {
        arrive(target);
    }
    close_slot();
}

void segment_writer_wait(uint32_t ticks, uint32_t pins_set, uint32_t pins_clear) {
    int64_t here[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        here[axis] = writer.axes[axis].place;
    }
    write_segment(here, &(pace_t){.ticks = ticks});
    segment_t *segment = open_slot();
    segment->pins_set = pins_set;
    segment->pins_clear = pins_clear;
    segment->flags |= SEGMENT_MAY_END;
    close_slot();
}
