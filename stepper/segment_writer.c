// From positions and times to phases, rates and ramps.
//
// The exact position of each axis is kept in 2^-32 of a step and moves by the sum of the rates of
// each segment, nothing else; whatever rounding leaves over stays in the distance to the next
// target. The motor stands at the nearest whole step: floor(position + 1/2). Hence the phase, which
// is the fraction of position + 1/2, counts up to the next step; for a direction down it is
// mirrored.
//
// A target is where the path is at a time that may lie between two ticks. The segment ends at the
// last tick before, with the rate of the path, and the rest of the way has the rest of the time.
#include "stepper/segment_writer.h"

#include "stepper/pace.h"
#include "stepper/step_isr.h"

#define HALF_STEP (STEP_ONE / 2)
// Distances below this are rounding, not motion: 1/4096 of a step. They must not turn an axis
// round.
#define NO_DISTANCE ((int64_t)1 << 20)
#define AXES ((1u << AXIS_COUNT) - 1u) // of the flags of a segment
#define ROOM 4                         // segments: one call writes up to that many
// What is rare stays out of the quick way, which has too few registers on a Cortex-M0+ as it is.
#define SEPARATE __attribute__((noinline))

typedef struct {
    int64_t place;      // 2^-32 steps, end of the last segment
    uint32_t last_rate; // in its last tick
    uint32_t dir;       // pin mask
} writer_axis_t;

static struct {
    writer_axis_t axes[AXIS_COUNT];
    uint32_t flags; // of segments: bit n: axis n counts down; upper half: PWM level
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
        uint32_t mean = pace_mean_rate(pace, way);
        out->rate = mean;
        out->ramp = 0;
        from->last_rate = mean;
        if (pace->slope != 0) {
            mean = pace_set_ramp(pace, out, mean);
            from->last_rate = 2 * mean - out->rate;
        }
        int64_t moved = pace_way(mean, pace->ticks);
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

static inline uint32_t go(const way_t *way) {
    pace_t *pace = &writer.paces[writer.recent];
    if (!pace_is_for(pace, way->due, way->change)) {
        writer.recent ^= 1;
        pace = &writer.paces[writer.recent];
        if (!pace_is_for(pace, way->due, way->change)) {
            pace_set(pace, way->due, way->change);
        }
    }
    return write_segment(way->target, pace);
}

// Goes only one tick of what is in the open slot. `standing`: axes that do not take part.
static void go_one_tick(way_t *way, uint32_t standing) {
    shorten(1, standing);
    close_slot();
    if (way->due >= 2 * PACE_TICK) {
        // With the mean speed as 1, a tick of the way from 1 - change to 1 + change is done.
        int32_t done = PACE_TICK + way->change / (SEGMENT_CHANGE_ONE / PACE_TICK);
        way->due -= PACE_TICK;
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
        go(&(way_t){.target = target, .due = ticks * PACE_TICK});
    }
    open_slot()->flags |= SEGMENT_MAY_END;
    writer.late = 0;
}

void segment_writer_move(const int64_t target[AXIS_COUNT], float ticks, int32_t change,
                         bool at_rest) {
    int32_t due = (int32_t)(uint32_t)(ticks * (float)PACE_TICK) + writer.late;
    if (due < PACE_TICK && !at_rest) {
        writer.late = due; // less than a tick: the next one goes this way, too
        return;
    }
    way_t way = {.target = target, .due = due, .change = change};
    uint32_t turning = go(&way);
    if (turning != 0) {
        turn(&way, turning);
    }
    writer.late = way.due - (int32_t)open_slot()->ticks * PACE_TICK;
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
