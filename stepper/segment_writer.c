// Positions and times to phases and rates.
//
// The exact position of each axis is kept in 2^-32 of a step and moves by rate * ticks with each
// segment, nothing else; whatever a division leaves over stays in the distance to the next target. The
// motor stands at the nearest whole step: floor(position + 1/2). Hence the phase, which is
// the fraction of position + 1/2, counts up to the next step; for a direction down it is mirrored.
#include "stepper/segment_writer.h"

#include <string.h>

#define HALF_STEP (STEP_ONE / 2)
#define RATE_MAX ((uint32_t)1 << 31) // a step in every second tick
// Distances below this are rounding, not motion: 1/4096 of a step. They must not turn an axis round.
#define NO_DISTANCE ((int64_t)1 << 20)
#define ROOM 4 // segments: one call writes up to three

static struct {
    int64_t position[AXIS_COUNT]; // 2^-32 steps, end of the last segment
    uint32_t negative;            // bit n: axis n counts down
    uint32_t dir[AXIS_COUNT];
    uint32_t dir_inverted;
    float late_ticks; // by how much the segments lag behind the times they should have had
    uint32_t end_ticks;
} writer;

// Segments that were dropped may have been about to turn an axis round, so the pins have the last word.
static void follow_dir_pins(void) {
    uint32_t pins = hal_pins_read();
    writer.negative = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        uint32_t low = (pins & writer.dir[axis]) != 0 ? 0 : 1u << axis;
        writer.negative |= writer.dir[axis] != 0 ? low ^ (writer.dir_inverted & 1u << axis) : 0;
    }
}

void segment_writer_reset(const int32_t steps[AXIS_COUNT]) {
    follow_dir_pins();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        writer.position[axis] = steps[axis] * STEP_ONE;
    }
    writer.late_ticks = 0.0f;
}

void segment_writer_set_dir_pins(const uint32_t dir[AXIS_COUNT], uint32_t inverted) {
    memcpy(writer.dir, dir, sizeof writer.dir);
    writer.dir_inverted = inverted;
    writer.negative = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        bool low = (inverted >> axis) & 1;
        hal_pins_set(low ? 0 : dir[axis]);
        hal_pins_clear(low ? dir[axis] : 0);
    }
}

static int32_t motor_steps(axis_id_t axis) {
    return (int32_t)((writer.position[axis] + HALF_STEP) >> 32);
}

void segment_writer_end_steps(int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = motor_steps(axis);
    }
}

void segment_writer_settle(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        writer.position[axis] = motor_steps(axis) * STEP_ONE;
    }
    writer.late_ticks = 0.0f;
}

uint32_t segment_writer_ahead_ticks(void) {
    if (ring_used(&segments.ring) == 0) {
        return 0;
    }
    const segment_t *oldest = &segments.slots[segments.ring.take_slot];
    return writer.end_ticks - (oldest->end_ticks - oldest->ticks);
}

bool segment_writer_has_room(void) {
    return ring_free(&segments.ring) >= ROOM;
}

// The slot to fill, with everything at rest.
static segment_t *open_segment(uint32_t ticks) {
    segment_t *segment = &segments.slots[segments.ring.put_slot];
    *segment = (segment_t){.ticks = ticks, .flags = writer.negative};
    segment_writer_end_steps(segment->start_steps);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        uint32_t phase = (uint32_t)(writer.position[axis] + HALF_STEP);
        bool negative = (writer.negative >> axis) & 1;
        *segment_phase(segment, axis) = negative ? ~phase : phase;
    }
    writer.end_ticks += ticks;
    segment->end_ticks = writer.end_ticks;
    return segment;
}

static int64_t distance_to(axis_id_t axis, const int64_t target[AXIS_COUNT]) {
    int64_t distance = target[axis] - writer.position[axis];
    return distance < NO_DISTANCE && distance > -NO_DISTANCE ? 0 : distance;
}

// `ticks` of a way to `target` that takes `whole_ticks`; axes of the mask `waiting` stand.
static segment_t *write_way(const int64_t target[AXIS_COUNT], uint32_t ticks, uint32_t whole_ticks,
                            uint32_t waiting) {
    segment_t *segment = open_segment(ticks);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t distance = distance_to(axis, target);
        if (distance == 0 || ((waiting >> axis) & 1)) {
            continue;
        }
        uint64_t rate = (uint64_t)(distance < 0 ? -distance : distance) / whole_ticks;
        rate = rate < RATE_MAX ? rate : RATE_MAX;
        *segment_rate(segment, axis) = (uint32_t)rate;
        int64_t moved = (int64_t)(rate * ticks);
        writer.position[axis] += distance < 0 ? -moved : moved;
    }
    return segment;
}

// Axes whose next motion is against their direction pin.
static uint32_t reversing_axes(const int64_t target[AXIS_COUNT]) {
    uint32_t reversing = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t distance = distance_to(axis, target);
        if (distance != 0) {
            uint32_t negative = distance < 0 ? 1u << axis : 0;
            reversing |= negative ^ (writer.negative & 1u << axis);
        }
    }
    return reversing;
}

static void switch_directions(segment_t *segment, uint32_t reversing) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((reversing >> axis) & 1) {
            bool high = (((writer.negative ^ writer.dir_inverted) >> axis) & 1) == 0;
            segment->pins_set |= high ? writer.dir[axis] : 0;
            segment->pins_clear |= high ? 0 : writer.dir[axis];
        }
    }
}

// Fewest ticks in which every axis can make its way to `target`.
static uint32_t ticks_needed(const int64_t target[AXIS_COUNT]) {
    int64_t farthest = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t distance = distance_to(axis, target);
        distance = distance < 0 ? -distance : distance;
        farthest = distance > farthest ? distance : farthest;
    }
    return (uint32_t)((farthest + RATE_MAX - 1) / RATE_MAX);
}

void segment_writer_move(const int64_t target[AXIS_COUNT], float ticks, int32_t change,
                         bool at_rest) {
    (void)change; // within a segment the speed is constant
    float due = ticks + writer.late_ticks;
    uint32_t whole = due >= 1.5f ? (uint32_t)(due + 0.5f) : 1;
    writer.late_ticks = due - (float)whole;

    // An axis that turns round stands for two ticks, and its direction pin changes between them: as
    // far from the end of the last pulse as from the next.
    uint32_t reversing = reversing_axes(target);
    if (reversing != 0) {
        write_way(target, 1, whole, reversing);
        ring_put(&segments.ring);
        whole -= whole > 1;
        writer.negative ^= reversing;
        segment_t *turn = write_way(target, 1, whole, reversing);
        switch_directions(turn, reversing);
        ring_put(&segments.ring);
        whole -= whole > 1;
    }
    // The rate limit may have left something of the way; the next segment makes up for it, but the
    // last one has to arrive.
    if (at_rest && whole < ticks_needed(target)) {
        whole = ticks_needed(target);
    }
    segment_t *segment = write_way(target, whole, whole, 0);
    if (at_rest) {
        segment->flags |= SEGMENT_MAY_END;
        writer.late_ticks = 0.0f;
    }
    ring_put(&segments.ring);
}

void segment_writer_wait(uint32_t ticks, uint32_t pins_set, uint32_t pins_clear) {
    segment_t *segment = open_segment(ticks);
    segment->pins_set = pins_set;
    segment->pins_clear = pins_clear;
    segment->flags |= SEGMENT_MAY_END;
    ring_put(&segments.ring);
}
