// Look-ahead. A block may be entered no faster than its corner allows and no faster than lets it brake
// for all that follows: entry^2 <= next entry^2 + 2 * acceleration * length, the last one ending at
// rest. Entry speeds are upper bounds: the governor accelerates within the limits anyway, and arriving
// slower than planned is always safe.
//
//   cap   ----.   .---------.        entry_cap: corner and feed
//             |   |         |
//   entry --. '---'     .   '--.     entry: what braking allows, from the newest block backwards
//            \_________/ \      \ 0
//
// With climb(k) = the sum of 2 * acceleration * length of all blocks before k this reads
// entry(k)^2 = min over all n >= k of (cap(n)^2 + climb(n)) - climb(k). The bracket does not depend on k, so
// nothing is ever planned anew: a queue of the blocks whose bracket is below those of all later ones has the
// answer at its front. A new block takes those above its own off the back, each block once. The end
// of the path, cap 0, moves with each block and is kept beside the queue. These are also the only places
// that the governor has to look at when it limits the jerk.
// Context: main loop, the queue with the governor locked; the governor for what its section says.
#include "stepper/planner.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "stepper/arc.h"
#include "stepper/axis.h"
#include "stepper/geometry.h"
#include "stepper/governor.h"

// A line, its blend and the next line, and one to spare.
#define BLEND_RING_MIN 4u

planner_ring_t blocks;

static struct {
    double commanded[AXIS_COUNT]; // end of the last move, units, also if it was too short to queue
    double target[AXIS_COUNT];    // end of the last queued move, units
    int32_t target_steps[AXIS_COUNT];
    bool corner; // the last queued block is a move, `last` is what it is like
    bool blends; // the last one is a line that may be rounded off at its end
    geometry_t last;
    float way_rest; // what `way` of the newest block leaves out, 0..1
    float end_way_rest;
} planner;

static const span_t span_unlimited = {.acceleration = UINT16_MAX, .jerk = UINT8_MAX};

static void clear_binding(void) {
    blocks.binding.first = 0;
    blocks.binding.count = 0;
    blocks.end_span = span_unlimited;
}

void planner_reset(uint32_t size) {
    ring_reset(&blocks.ring, size);
    clear_binding();
    blocks.front_started = false;
    planner.corner = false;
}

void planner_set_scale(void) {
    float fastest2 = 1.0f;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (axes[axis].configured) {
            fastest2 += axes[axis].velocity * axes[axis].velocity;
        }
    }
    blocks.v2_unit = fastest2 / (float)V2_MAX;
    blocks.v2_per_unit = (float)V2_MAX / fastest2;
}

void planner_set_position(const int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        planner.target_steps[axis] = steps[axis];
        planner.target[axis] = axis_from_steps(axis, steps[axis]);
        planner.commanded[axis] = planner.target[axis];
    }
    planner.corner = false;
}

void planner_target(double target[AXIS_COUNT]) {
    memcpy(target, planner.commanded, sizeof planner.commanded);
}

static float lesser(float a, float b) {
    return a < b ? a : b;
}

static v2_t v2_from(float speed2) {
    float units = speed2 * blocks.v2_per_unit;
    return units < (float)V2_MAX ? (v2_t)units : V2_MAX;
}

// ---- Spans ---------------------------------------------------------------------------------------

#define JERK_CODE_BASE ((127u - 20u) << 2) // of 2^-20

static uint32_t float_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_from_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

span_t planner_span_of(const block_t *block) {
    if (!block_is_move(block)) {
        return span_unlimited;
    }
    uint32_t jerk = float_bits(block->move.jerk) >> 21;
    if (jerk == 0) {
        jerk = UINT8_MAX; // not limited
    } else {
        jerk = jerk > JERK_CODE_BASE ? jerk - JERK_CODE_BASE : 0;
    }
    return (span_t){
        .acceleration = (uint16_t)(float_bits(block->move.acceleration) >> 16),
        .jerk = (uint8_t)(jerk < UINT8_MAX ? jerk : UINT8_MAX),
    };
}

float span_acceleration(span_t span) {
    return float_from_bits((uint32_t)span.acceleration << 16);
}

float span_jerk(span_t span) {
    return float_from_bits((span.jerk + JERK_CODE_BASE) << 21);
}

span_t span_least(span_t a, span_t b) {
    return (span_t){
        .acceleration = a.acceleration < b.acceleration ? a.acceleration : b.acceleration,
        .jerk = a.jerk < b.jerk ? a.jerk : b.jerk,
    };
}

// ---- The queue of binding caps -------------------------------------------------------------------

static uint32_t slot_before(uint32_t slot) {
    return slot > 0 ? slot - 1 : blocks.ring.size - 1;
}

static uint32_t binding_index(uint32_t n) {
    uint32_t index = blocks.binding.first + n;
    return index < STEPPER_BLOCKS_MAX ? index : index - STEPPER_BLOCKS_MAX;
}

// What is `length` of way and `gain` of speed further on.
static void set_end(const block_t *block) {
    blocks.end_way = block->way;
    blocks.end_climb = block->climb;
    planner.end_way_rest = planner.way_rest;
    if (block_is_move(block)) {
        // What is lost by the integer is made up for in the next move.
        float way = block->move.length * WAY_ONE + planner.way_rest;
        uint32_t whole = (uint32_t)way;
        planner.end_way_rest = way - (float)whole;
        blocks.end_way += whole;
        blocks.end_climb += v2_from(2.0f * block->move.acceleration * block->move.length);
    }
}

// Takes the farthest binding entry away, whose limits count for `span` from now on.
static void unbind_last(span_t *span) {
    uint32_t last = binding_index(blocks.binding.count - 1);
    const block_t *block = &blocks.slots[blocks.binding.slot[last]];
    *span = span_least(*span, (span_t){block->span_acceleration, block->span_jerk});
    blocks.binding.count--;
    if (blocks.binding.count > 0) {
        last = last > 0 ? last - 1 : STEPPER_BLOCKS_MAX - 1;
        block = &blocks.slots[blocks.binding.slot[last]];
        blocks.binding.last_key = block->climb + blocks.binding.cap[last];
    }
}

// Counts a new entry for the group of its neighbours.
static inline void join_group(uint32_t index, v2_t cap, span_t span) {
    uint32_t group = index / PLANNER_GROUP;
    if (index % PLANNER_GROUP == 0 || blocks.binding.count == 0) {
        blocks.binding.group_cap[group] = cap;
        blocks.binding.group_span[group] = span;
        return;
    }
    if (cap < blocks.binding.group_cap[group]) {
        blocks.binding.group_cap[group] = cap;
    }
    blocks.binding.group_span[group] = span_least(blocks.binding.group_span[group], span);
}

// Takes up the entry cap of the block, the one behind those that were taken up before; its way and climb
// are known.
__attribute__((always_inline)) static inline void bind(uint32_t slot) {
    block_t *block = &blocks.slots[slot];
    span_t own = planner_span_of(block);
    if (!block->binds) {
        blocks.end_span = span_least(blocks.end_span, own);
        return;
    }
    v2_t cap = block_is_move(block) ? block->move.entry_cap : 0;
    uint64_t key = block->climb + cap;
    span_t span = blocks.end_span;
    while (blocks.binding.count > 0 && blocks.binding.last_key >= key) {
        unbind_last(&span);
    }
    block->span_acceleration = span.acceleration;
    block->span_jerk = span.jerk;
    uint32_t index = binding_index(blocks.binding.count);
    blocks.binding.slot[index] = (uint16_t)slot;
    blocks.binding.cap[index] = cap;
    join_group(index, cap, span);
    blocks.binding.count++;
    blocks.binding.last_key = key;
    blocks.end_span = own;
}

static float top_speed(const block_t *move, const planner_override_t *override) {
    return move->move.feed > 0.0f ? fminf(move->move.axes_speed, move->move.feed * override->feed)
                                  : move->move.axes_speed * override->rapid;
}

float planner_top_speed(const block_t *move) {
    return top_speed(move, &blocks.override);
}

// The corner within the speeds on both sides of it. It binds unless the block before is that slow anyway.
static void find_entry_cap(const block_t *before, block_t *block,
                           const planner_override_t *override) {
    block->binds = true;
    if (!block_is_move(block)) {
        return;
    }
    block->move.entry_cap = 0;
    if (!block_is_move(before) || block->move.corner == 0) {
        return;
    }
    float speed_before = top_speed(before, override);
    float speed = top_speed(block, override);
    v2_t side = v2_from(speed * speed);
    v2_t cap = side < block->move.corner ? side : block->move.corner;
    block->move.entry_cap = cap;
    block->binds = cap < v2_from(speed_before * speed_before);
}

// ---- New blocks ----------------------------------------------------------------------------------

static block_t *next_slot(void) {
    return &blocks.slots[blocks.ring.put_slot];
}

// Puts the block in the next slot, which is complete but for its place, behind all others. Governor locked.
static void publish(void) {
    uint32_t slot = blocks.ring.put_slot;
    block_t *block = &blocks.slots[slot];
    block->way = blocks.end_way;
    block->climb = blocks.end_climb;
    planner.way_rest = planner.end_way_rest;
    bind(slot);
    set_end(block);
    ring_put(&blocks.ring);
}

// Puts the block in next_slot(), whose own part is filled in, behind all others.
static void push_block(void) {
    uint32_t slot = blocks.ring.put_slot;
    block_t *block = &blocks.slots[slot];
    find_entry_cap(&blocks.slots[slot_before(slot)], block, &blocks.override);
    hal_governor_lock();
    if (ring_used(&blocks.ring) == 0) {
        clear_binding();
        block->binds = false; // it starts at rest
    }
    publish();
    hal_governor_unlock();
}

static void fill_move(block_t *block, const geometry_t *g, float corner2,
                      const int32_t target_steps[AXIS_COUNT]) {
    memcpy(block->move.target, target_steps, sizeof block->move.target);
    block->move.length = g->length;
    block->move.axes_speed = g->axes_speed;
    block->move.feed = g->feed;
    block->move.acceleration = g->acceleration;
    block->move.jerk = g->jerk;
    block->move.corner = v2_from(corner2);
}

// ---- Blends --------------------------------------------------------------------------------------

// The newest block is a line that nobody has begun to follow; the corner behind it may still be changed.
static bool may_shorten(void) {
    uint32_t used = ring_used(&blocks.ring);
    return planner.corner && planner.blends && blocks.ring.size >= BLEND_RING_MIN &&
           (used > 1 || (used == 1 && !blocks.front_started));
}

uint32_t planner_free(void) {
    uint32_t free = ring_free(&blocks.ring);
    return free - (free > 0 && may_shorten());
}

// A distance in which the machine can come to a standstill whatever it does now, at `speed` and any
// acceleration: the latter is taken back first.
static float stop_length(float speed, float acceleration, float jerk) {
    float ramp = acceleration / jerk;
    float top = speed + 0.5f * acceleration * ramp;
    return top * (0.5f * top / acceleration + 2.0f * ramp);
}

// Whether the machine can still stop before the newest line ends, if that is `length` long. Only then may
// its end be changed: what is done already does not depend on anything behind it.
static bool is_far_ahead(const block_t *line, float length) {
    float speed, left;
    governor_whereabouts(&speed, &left);
    if (speed <= 0.0f) {
        return true;
    }
    const block_t *front = planner_front();
    const block_t *second = planner_second();
    if (line->move.jerk > 0.0f) {
        left += (float)(line->way - second->way) / WAY_ONE + length;
        float acceleration = lesser(front->move.acceleration, line->move.acceleration);
        float jerk = lesser(front->move.jerk, line->move.jerk);
        return stop_length(speed, acceleration, jerk) < left;
    }
    float overrun2 = speed * speed - 2.0f * front->move.acceleration * left;
    v2_t gain = v2_from(2.0f * line->move.acceleration * length);
    return overrun2 <= 0.0f || v2_from(overrun2) < line->climb - second->climb + gain;
}

// Cuts `lead` in 2^-32 off the end of the newest block, a line. False: it is too late for that. Governor
// locked.
static bool shorten(uint32_t slot, uint32_t lead) {
    block_t *line = &blocks.slots[slot];
    float rest = geometry_part(&planner.last, line->move.line.lead_in, lead);
    if (!may_shorten() || !is_far_ahead(line, rest)) {
        return false;
    }
    line->move.line.lead_out = lead;
    line->move.length = rest;
    set_end(line);
    return true;
}

// Rounds the corner to the new line `g` off: a block for the parabola and one for what is left of the line.
// False if that is not possible or no use.
static bool push_blended(const geometry_t *g, const stepper_move_t *move,
                         const int32_t target_steps[AXIS_COUNT]) {
    geometry_t curve;
    float reach;
    if (move->corner != STEPPER_CORNER_BLEND || !may_shorten() || ring_free(&blocks.ring) < 2 ||
        !geometry_blend(&curve, &planner.last, g, (float)move->blend_mm, &reach)) {
        return false;
    }
    uint32_t slot = blocks.ring.put_slot;
    uint32_t before = slot_before(slot);
    uint32_t behind = slot + 1 < blocks.ring.size ? slot + 1 : 0;
    block_t *blend = &blocks.slots[slot];
    block_t *line = &blocks.slots[behind];
    *blend = (block_t){.kind = BLOCK_BLEND};
    fill_move(blend, &curve, FLT_MAX, planner.target_steps);
    *line = (block_t){.kind = BLOCK_LINE};
    fill_move(line, g, FLT_MAX, target_steps);
    line->move.line.lead_in = geometry_fraction(g, reach);
    line->move.length = geometry_part(g, line->move.line.lead_in, 0);
    find_entry_cap(&blocks.slots[before], blend, &blocks.override);
    find_entry_cap(blend, line, &blocks.override);
    hal_governor_lock();
    bool done = shorten(before, geometry_fraction(&planner.last, reach));
    if (done) {
        publish();
        publish();
    }
    hal_governor_unlock();
    return done;
}

// ---- New moves -----------------------------------------------------------------------------------

// The move `g` is queued; the next one starts behind it.
static void follow_move(const geometry_t *g, const stepper_move_t *move,
                        const int32_t target_steps[AXIS_COUNT]) {
    memcpy(planner.target, move->target, sizeof planner.target);
    memcpy(planner.target_steps, target_steps, sizeof planner.target_steps);
    planner.last = *g;
    planner.corner = true;
}

static void find_delta(double delta[AXIS_COUNT], const stepper_move_t *move) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        delta[axis] = move->target[axis] - planner.target[axis];
    }
}

static float corner_before(const geometry_t *g, const stepper_move_t *move) {
    return planner.corner ? geometry_corner_speed2(&planner.last, g, move->corner) : 0.0f;
}

static bool ends_where_it_starts(const int32_t target_steps[AXIS_COUNT]) {
    return memcmp(target_steps, planner.target_steps, sizeof planner.target_steps) == 0;
}

void planner_push_line(const stepper_move_t *move, const int32_t target_steps[AXIS_COUNT]) {
    memcpy(planner.commanded, move->target, sizeof planner.commanded);
    if (ends_where_it_starts(target_steps)) {
        return;
    }
    double delta[AXIS_COUNT];
    find_delta(delta, move);
    geometry_t g;
    geometry_line(&g, delta, move);
    geometry_even_out(&g);
    if (!push_blended(&g, move, target_steps)) {
        block_t *block = next_slot();
        *block = (block_t){.kind = BLOCK_LINE};
        fill_move(block, &g, corner_before(&g, move), target_steps);
        push_block();
    }
    follow_move(&g, move, target_steps);
    planner.blends = move->corner == STEPPER_CORNER_BLEND;
}

void planner_push_arc(const arc_t *arc, const stepper_move_t *move,
                      const int32_t target_steps[AXIS_COUNT]) {
    memcpy(planner.commanded, move->target, sizeof planner.commanded);
    if (ends_where_it_starts(target_steps) && arc_is_below_a_step(arc)) {
        return;
    }
    double delta[AXIS_COUNT];
    find_delta(delta, move);
    geometry_t g;
    arc_geometry(&g, arc, delta, move);
    block_t *block = next_slot();
    *block = (block_t){.kind = BLOCK_ARC};
    arc_fill(block, arc);
    fill_move(block, &g, corner_before(&g, move), target_steps);
    push_block();
    follow_move(&g, move, target_steps);
    planner.blends = false;
}

void planner_push_dwell(uint32_t ticks) {
    *next_slot() = (block_t){.kind = BLOCK_DWELL, .dwell_ticks = ticks};
    planner.corner = false;
    push_block();
}

void planner_push_pins(uint32_t set, uint32_t clear) {
    *next_slot() = (block_t){.kind = BLOCK_PINS, .pins = {.set = set, .clear = clear}};
    planner.corner = false;
    push_block();
}

// A function of its own so that its time can be measured: the governor waits for it.
__attribute__((noinline)) static void bind_all(void) {
    clear_binding();
    uint32_t slot = blocks.ring.take_slot;
    for (uint32_t waiting = ring_used(&blocks.ring); waiting > 0; waiting--) {
        if (slot == blocks.ring.take_slot) {
            blocks.end_span = planner_span_of(&blocks.slots[slot]);
        } else {
            bind(slot);
        }
        slot = slot + 1 < blocks.ring.size ? slot + 1 : 0;
    }
}

// The caps of the blocks are no business of the governor's, so the long part runs unlocked; blocks that
// are executed meanwhile keep their contents. The queue and the factors change together.
void planner_set_override(const planner_override_t *override) {
    uint32_t slot = blocks.ring.put_slot;
    for (uint32_t waiting = ring_used(&blocks.ring); waiting > 1; waiting--) {
        slot = slot_before(slot);
        find_entry_cap(&blocks.slots[slot_before(slot)], &blocks.slots[slot], override);
    }
    hal_governor_lock();
    blocks.override = *override;
    blocks.overrides++;
    bind_all();
    hal_governor_unlock();
}

// ---- For the governor ----------------------------------------------------------------------------

static const block_t *block_ahead(uint32_t n) {
    if (ring_used(&blocks.ring) <= n) {
        return NULL;
    }
    uint32_t slot = blocks.ring.take_slot + n;
    return &blocks.slots[slot < blocks.ring.size ? slot : slot - blocks.ring.size];
}

const block_t *planner_front(void) {
    return block_ahead(0);
}

const block_t *planner_second(void) {
    return block_ahead(1);
}

void planner_start(void) {
    blocks.front_started = true;
    if (blocks.binding.count > 0 &&
        blocks.binding.slot[blocks.binding.first] == blocks.ring.take_slot) {
        blocks.binding.first = binding_index(1);
        blocks.binding.count--;
    }
}

void planner_release(void) {
    blocks.front_started = false;
    ring_take(&blocks.ring);
}

void planner_release_all(void) {
    while (ring_used(&blocks.ring) > 0) {
        planner_release();
    }
    clear_binding();
}

float planner_exit_speed2(void) {
    const block_t *second = planner_second();
    if (second == NULL) {
        return 0.0f;
    }
    uint64_t least = blocks.end_climb;
    if (blocks.binding.count > 0) {
        uint32_t first = blocks.binding.first;
        uint64_t key = blocks.slots[blocks.binding.slot[first]].climb + blocks.binding.cap[first];
        least = key < least ? key : least;
    }
    uint64_t entry2 = least - second->climb;
    return (float)(v2_t)(entry2 < V2_MAX ? entry2 : V2_MAX) * blocks.v2_unit;
}
