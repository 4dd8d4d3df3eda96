// Look-ahead. A block may be entered no faster than its corner allows and no faster than lets it brake
// for all that follows: entry^2 <= next entry^2 + 2 * acceleration * length, the last one ending at
// rest. Entry speeds are upper bounds, so no forward pass is needed: the governor accelerates
// within the limits anyway, and arriving slower than planned is always safe.
//
//   cap   ----.   .---------.        entry_cap: corner and feed
//             |   |         |
//   entry --. '---'     .   '--.     entry: what braking allows, from the newest block backwards
//            \_________/ \      \ 0
//
// Corner speed: junction deviation. The corner is thought replaced by an arc that passes at most
// `deviation` from it; v^2 = a * r on that arc. An arc must also leave each block at its middle at the
// latest, so on a polygon with many corners v^2 / r of the circle stays within the acceleration too.
// Context: main loop; the passes run with the governor locked.
#include "stepper/planner.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "stepper/axis.h"

// |u - u_prev|^2 = 2 (1 - cos) for unit vectors: straight on below the first, back the same way
// above the second.
#define STRAIGHT_ON 1e-9f
#define REVERSAL 3.99999f

planner_ring_t blocks;

static struct {
    double commanded[AXIS_COUNT]; // end of the last move, units, also if it was too short to queue
    double target[AXIS_COUNT];    // end of the last queued move, units
    int32_t target_steps[AXIS_COUNT];
    float direction[AXIS_COUNT]; // of the last queued block; all 0: it was not a move
    float length;                // of the last queued move
    float deviation;
} planner;

void planner_reset(uint32_t size) {
    ring_reset(&blocks.ring, size);
    memset(planner.direction, 0, sizeof planner.direction);
}

void planner_set_scale(void) {
    float fastest2 = 1.0f;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (axes[axis].configured) {
            fastest2 += axes[axis].velocity * axes[axis].velocity;
        }
    }
    blocks.v2_unit = fastest2 / (float)V2_MAX;
}

void planner_set_position(const int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        planner.target_steps[axis] = steps[axis];
        planner.target[axis] = axis_from_steps(axis, steps[axis]);
        planner.commanded[axis] = planner.target[axis];
    }
    memset(planner.direction, 0, sizeof planner.direction);
}

void planner_target(double target[AXIS_COUNT]) {
    memcpy(target, planner.commanded, sizeof planner.commanded);
}

void planner_set_junction_deviation(float deviation_mm) {
    planner.deviation = deviation_mm;
}

float planner_junction_deviation(void) {
    return planner.deviation;
}

static v2_t v2_from(float speed2) {
    float units = speed2 / blocks.v2_unit;
    return units < (float)V2_MAX ? (v2_t)units : V2_MAX;
}

// ---- Geometry of a new move ----------------------------------------------------------------------

typedef struct {
    float direction[AXIS_COUNT];
    float length;      // in all axes
    float feed_length; // what the feed counts: X, Y, Z; A if it moves alone
    float axes_speed;
    float feed; // 0: rapid
    float acceleration;
} geometry_t;

static void measure(geometry_t *g, const double target[AXIS_COUNT]) {
    double delta[AXIS_COUNT];
    double linear2 = 0.0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        delta[axis] = target[axis] - planner.target[axis];
        linear2 += axis < AXIS_A ? delta[axis] * delta[axis] : 0.0;
    }
    double length = sqrt(linear2 + delta[AXIS_A] * delta[AXIS_A]);
    g->length = (float)length;
    g->feed_length = linear2 > 0.0 ? sqrtf((float)linear2) : g->length;
    float per_length = 1.0f / g->length;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        g->direction[axis] = (float)delta[axis] * per_length;
    }
}

static void limit(geometry_t *g, const stepper_move_t *move) {
    g->feed = move->rapid ? 0.0f : (float)move->feed / 60.0f * (g->length / g->feed_length);
    g->axes_speed = FLT_MAX;
    g->acceleration = FLT_MAX;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        float share = fabsf(g->direction[axis]);
        if (share > 0.0f && axes[axis].configured) {
            g->axes_speed = fminf(g->axes_speed, axes[axis].velocity / share);
            g->acceleration = fminf(g->acceleration, axes[axis].acceleration / share);
        }
    }
}

// Acceleration that the axes together allow in the direction of `change`, whose length is `size`.
static float acceleration_along(const float change[AXIS_COUNT], float size) {
    float acceleration = FLT_MAX;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        float share = fabsf(change[axis]) / size;
        if (share > 1e-6f && axes[axis].configured) {
            acceleration = fminf(acceleration, axes[axis].acceleration / share);
        }
    }
    return acceleration;
}

// Square of the speed that the corner between the last queued move and `g` allows.
static float corner_speed2(const geometry_t *g) {
    float change[AXIS_COUNT];
    float change2 = 0.0f;
    float previous2 = 0.0f;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        change[axis] = g->direction[axis] - planner.direction[axis];
        change2 += change[axis] * change[axis];
        previous2 += planner.direction[axis] * planner.direction[axis];
    }
    if (previous2 == 0.0f || change2 > REVERSAL) {
        return 0.0f;
    }
    if (change2 < STRAIGHT_ON) {
        return FLT_MAX;
    }
    // With phi the angle between the moves: change2 / 4 = sin^2(phi/2). Junction deviation in the
    // usual form is r = deviation * s / (1 - s), s = cos(phi/2); 1 - s = sin^2(phi/2) / (1 + s) keeps
    // its precision at small angles.
    float sin2 = change2 * 0.25f;
    float s = sqrtf(1.0f - sin2);
    float acceleration = acceleration_along(change, sqrtf(change2));
    float by_deviation = acceleration * planner.deviation * s * (1.0f + s) / sin2;
    float half_length = 0.5f * fminf(g->length, planner.length);
    float by_length = acceleration * half_length * s / sqrtf(sin2);
    return fminf(by_deviation, by_length);
}

// ---- The ring ------------------------------------------------------------------------------------

static uint32_t slot_before(uint32_t slot) {
    return slot > 0 ? slot - 1 : blocks.ring.size - 1;
}

static float top_speed(const block_t *move, const planner_override_t *override) {
    return move->move.feed > 0.0f ? fminf(move->move.axes_speed, move->move.feed * override->feed)
                                  : move->move.axes_speed * override->rapid;
}

float planner_top_speed(const block_t *move) {
    return top_speed(move, &blocks.override);
}

// The corner within the speeds on both sides of it.
static v2_t entry_cap(const block_t *before, const block_t *block,
                      const planner_override_t *override) {
    if (before->kind != BLOCK_MOVE) {
        return 0;
    }
    float top = fminf(top_speed(before, override), top_speed(block, override));
    v2_t sides = v2_from(top * top);
    return sides < block->move.corner ? sides : block->move.corner;
}

// Backwards from the newest block to the one being executed, whose entry is history. Unless all caps
// are new it ends where an entry stays as it was: nothing before it can change then.
static void plan_backwards(bool all) {
    uint32_t used = ring_used(&blocks.ring);
    uint32_t slot = blocks.ring.put_slot;
    v2_t exit = 0;
    for (uint32_t waiting = used; waiting > 1; waiting--) {
        slot = slot_before(slot);
        block_t *block = &blocks.slots[slot];
        if (block->kind != BLOCK_MOVE) {
            if (!all) {
                return; // at rest there, and so it was before
            }
            exit = 0;
            continue;
        }
        v2_t reachable = block->move.gain < V2_MAX - exit ? block->move.gain + exit : V2_MAX;
        v2_t entry = reachable < block->move.entry_cap ? reachable : block->move.entry_cap;
        if (!all && entry == block->move.entry && waiting < used) {
            return;
        }
        block->move.entry = entry;
        exit = entry;
    }
}

static block_t *next_slot(void) {
    return &blocks.slots[blocks.ring.put_slot];
}

void planner_push_move(const stepper_move_t *move, const int32_t target_steps[AXIS_COUNT]) {
    memcpy(planner.commanded, move->target, sizeof planner.commanded);
    if (memcmp(target_steps, planner.target_steps, sizeof planner.target_steps) == 0) {
        return;
    }
    geometry_t g;
    measure(&g, move->target);
    limit(&g, move);

    block_t *block = next_slot();
    block->kind = BLOCK_MOVE;
    memcpy(block->move.target, target_steps, sizeof block->move.target);
    block->move.length = g.length;
    block->move.axes_speed = g.axes_speed;
    block->move.feed = g.feed;
    block->move.acceleration = g.acceleration;
    block->move.corner = v2_from(corner_speed2(&g));
    const block_t *before = &blocks.slots[slot_before(blocks.ring.put_slot)];
    block->move.entry_cap = block->move.corner > 0 ? entry_cap(before, block, &blocks.override) : 0;
    block->move.entry = 0;
    block->move.gain = v2_from(2.0f * g.acceleration * g.length);

    memcpy(planner.target, move->target, sizeof planner.target);
    memcpy(planner.target_steps, target_steps, sizeof planner.target_steps);
    memcpy(planner.direction, g.direction, sizeof planner.direction);
    planner.length = g.length;

    hal_governor_lock();
    ring_put(&blocks.ring);
    plan_backwards(false);
    hal_governor_unlock();
}

// The caps are no business of the governor's, so the long part runs unlocked; blocks that are executed
// meanwhile keep their contents. Entries and factors change together.
void planner_set_override(const planner_override_t *override) {
    uint32_t slot = blocks.ring.put_slot;
    for (uint32_t waiting = ring_used(&blocks.ring); waiting > 1; waiting--) {
        slot = slot_before(slot);
        block_t *block = &blocks.slots[slot];
        if (block->kind == BLOCK_MOVE) {
            block->move.entry_cap = entry_cap(&blocks.slots[slot_before(slot)], block, override);
        }
    }
    hal_governor_lock();
    blocks.override = *override;
    plan_backwards(true);
    hal_governor_unlock();
}

void planner_push_dwell(uint32_t ticks) {
    *next_slot() = (block_t){.kind = BLOCK_DWELL, .dwell_ticks = ticks};
    memset(planner.direction, 0, sizeof planner.direction);
    ring_put(&blocks.ring);
}

void planner_push_pins(uint32_t set, uint32_t clear) {
    *next_slot() = (block_t){.kind = BLOCK_PINS, .pins = {.set = set, .clear = clear}};
    memset(planner.direction, 0, sizeof planner.direction);
    ring_put(&blocks.ring);
}

const block_t *planner_front(void) {
    return ring_used(&blocks.ring) > 0 ? &blocks.slots[blocks.ring.take_slot] : NULL;
}

float planner_exit_speed2(void) {
    if (ring_used(&blocks.ring) < 2) {
        return 0.0f;
    }
    uint32_t slot = blocks.ring.take_slot + 1 < blocks.ring.size ? blocks.ring.take_slot + 1 : 0;
    const block_t *next = &blocks.slots[slot];
    return next->kind == BLOCK_MOVE ? (float)next->move.entry * blocks.v2_unit : 0.0f;
}

void planner_release(void) {
    ring_take(&blocks.ring);
}
