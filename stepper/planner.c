// Look-ahead. A block may be entered no faster than its corner allows and no faster than lets it
// brake for all that follows: entry^2 <= next entry^2 + 2 * acceleration * length, the last one
// ending at rest. Entry speeds are upper bounds: the governor accelerates within the limits anyway,
// and arriving slower than planned is always safe.
//
//   cap   ----.   .---------.        entry_cap: corner and feed
//             |   |         |
//   entry --. '---'     .   '--.     entry: what braking allows, from the newest block backwards
//            \_________/ \      \ 0
//
// With climb(k) = the sum of 2 * acceleration * length of all blocks before k this reads entry(k)^2
// = min over all n >= k of (cap(n)^2 + climb(n)) - climb(k). The bracket does not depend on k, so
// nothing is ever planned anew: a queue of the blocks whose bracket is below those of all later
// ones has the answer at its front. A new block takes those above its own off the back, each block
// once. The end of the path, cap 0, moves with each block and is kept beside the queue. These are
// also the only places that the governor has to look at when it limits the jerk. Context: main
// loop, the queue with the governor locked; the governor for what its section says.
#include "stepper/planner.h"

#include <math.h>

#include "stepper/axis.h"
#include "stepper/lines.h"

planner_ring_t blocks;

static struct {
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
    lines_restart();
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

v2_t planner_v2(float speed2) {
    float units = speed2 * blocks.v2_per_unit;
    return units < (float)V2_MAX ? (v2_t)units : V2_MAX;
}

// Codes are upper bits of a float, five of the exponent and eleven behind the leading one. The bits
// of floats above 0 compare like what they stand for, in less time.
#define CODE_SHIFT 12
#define CODE_BASE (127u << 11) // of 2^0

static inline v2_code_t code_of(uint32_t float_bits) {
    uint32_t code = float_bits >> CODE_SHIFT;
    if (code <= CODE_BASE) {
        return 0;
    }
    code -= CODE_BASE;
    return (v2_code_t)(code < V2_CODE_MAX ? code : V2_CODE_MAX);
}

static inline uint32_t float_bits_of(v2_code_t code) {
    return (code + CODE_BASE) << CODE_SHIFT;
}

static inline v2_t v2_of(v2_code_t code) {
    uint32_t digits = (code & 0x7FFu) | 0x800u;
    uint32_t exponent = code >> 11;
    if (code == 0) {
        return 0;
    }
    return exponent > 11 ? digits << (exponent - 11) : digits >> (11 - exponent);
}

v2_code_t planner_v2_code(float speed2) {
    return code_of(span_float_bits(speed2 * blocks.v2_per_unit));
}

static inline span_t limits_of(const block_t *block) {
    return block_is_move(block) ? span_of(block->move.acceleration, block->move.jerk)
                                : span_unlimited;
}

// ---- The queue of binding caps ------------------------------------------------------------------

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
        blocks.end_climb += planner_v2(2.0f * block->move.acceleration * block->move.length);
    }
}

// Takes the farthest binding entry away, whose limits count for `span` from now on.
static inline void unbind_last(binding_t *binding, span_t *span) {
    uint32_t last = binding_index(--binding->count);
    const block_t *block = &blocks.slots[binding->slot[last]];
    *span = span_least(*span, (span_t){block->span_acceleration, block->span_jerk});
    if (binding->count > 0) {
        last = last > 0 ? last - 1 : STEPPER_BLOCKS_MAX - 1;
        binding->last_key = blocks.slots[binding->slot[last]].climb + binding->cap[last];
    }
}

// Counts a new entry for the group of its neighbours.
static inline void join_group(binding_t *binding, uint32_t index, v2_t cap, span_t span) {
    uint32_t group = index / PLANNER_GROUP;
    if (index % PLANNER_GROUP == 0 || binding->count == 0) {
        binding->group_cap[group] = cap;
        binding->group_span[group] = span;
        return;
    }
    if (cap < binding->group_cap[group]) {
        binding->group_cap[group] = cap;
    }
    binding->group_span[group] = span_least(binding->group_span[group], span);
}

// Takes up the entry cap of the block, the one behind those that were taken up before; its way and
// climb are known. Returns the limits from the last binding entry to behind it; `before`: to its
// beginning.
__attribute__((always_inline)) static inline span_t bind(uint32_t slot, span_t before) {
    block_t *block = &blocks.slots[slot];
    span_t own = limits_of(block);
    if (!block->binds) {
        return span_least(before, own);
    }
    binding_t *binding = &blocks.binding;
    v2_t cap = block_is_move(block) ? v2_of(block->move.entry_cap) : 0;
    uint64_t key = block->climb + cap;
    while (binding->count > 0 && binding->last_key >= key) {
        unbind_last(binding, &before);
    }
    block->span_acceleration = before.acceleration;
    block->span_jerk = before.jerk;
    uint32_t index = binding_index(binding->count);
    binding->slot[index] = (uint16_t)slot;
    binding->cap[index] = cap;
    join_group(binding, index, cap, before);
    binding->count++;
    binding->last_key = key;
    return own;
}

static float top_speed(const block_t *move, const planner_override_t *override) {
    return move->move.feed > 0.0f ? fminf(move->move.axes_speed, move->move.feed * override->feed)
                                  : move->move.axes_speed * override->rapid;
}

float planner_top_speed(const block_t *move) {
    return top_speed(move, &blocks.override);
}

// The corner within the speeds on both sides of it. It binds unless the block before is that slow
// anyway.
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
    uint32_t units = span_float_bits(speed * speed * blocks.v2_per_unit);
    uint32_t units_before = span_float_bits(speed_before * speed_before * blocks.v2_per_unit);
    v2_code_t side = code_of(units);
    v2_code_t corner = block->move.corner;
    block->move.entry_cap = side < corner ? side : corner;
    // Compared exactly: moves of one speed in a row do not bind by what the code leaves out.
    block->binds = units < units_before || float_bits_of(corner) < units_before;
}

// ---- New blocks ---------------------------------------------------------------------------------

block_t *planner_free_slot(uint32_t n) {
    uint32_t slot = blocks.ring.put_slot + n;
    return &blocks.slots[slot < blocks.ring.size ? slot : slot - blocks.ring.size];
}

block_t *planner_newest(void) {
    return &blocks.slots[slot_before(blocks.ring.put_slot)];
}

void planner_find_caps(uint32_t count) {
    const block_t *before = planner_newest();
    for (uint32_t n = 0; n < count; n++) {
        find_entry_cap(before, planner_free_slot(n), &blocks.override);
        before = planner_free_slot(n);
    }
}

void planner_publish(uint32_t count) {
    for (; count > 0; count--) {
        block_t *block = planner_free_slot(0);
        if (ring_used(&blocks.ring) == 0) {
            clear_binding();
            block->binds = false; // it starts at rest
        }
        block->way = blocks.end_way;
        block->climb = blocks.end_climb;
        planner.way_rest = planner.end_way_rest;
        blocks.end_span = bind(blocks.ring.put_slot, blocks.end_span);
        set_end(block);
        ring_put(&blocks.ring);
    }
}

void planner_shorten(float length) {
    block_t *block = planner_newest();
    block->move.length = length;
    set_end(block);
}

// A function of its own so that its time can be measured: the governor waits for it.
__attribute__((noinline)) static void bind_all(void) {
    clear_binding();
    uint32_t slot = blocks.ring.take_slot;
    span_t span = limits_of(&blocks.slots[slot]);
    for (uint32_t waiting = ring_used(&blocks.ring); waiting > 1; waiting--) {
        slot = slot + 1 < blocks.ring.size ? slot + 1 : 0;
        span = bind(slot, span);
    }
    blocks.end_span = span;
}

// The caps of the blocks are no business of the governor's, so the long part runs unlocked; blocks
// that are executed meanwhile keep their contents. The queue and the factors change together.
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

span_t planner_span_of(const block_t *block) {
    return limits_of(block);
}

// ---- For the governor ---------------------------------------------------------------------------

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
    blocks.executed = blocks.executed + 1;
    ring_take(&blocks.ring);
}

void planner_release_all(void) {
    blocks.front_started = false;
    while (ring_used(&blocks.ring) > 0) {
        ring_take(&blocks.ring);
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
