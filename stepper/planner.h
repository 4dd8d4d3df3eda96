// The block ring and the look-ahead over it. Inside stepper/ only.
// The main loop writes blocks and plans them; the governor reads and releases them.
#ifndef STEPPER_PLANNER_H
#define STEPPER_PLANNER_H

#include "stepper/span.h"
#include "stepper/stepper.h"

typedef enum {
    BLOCK_LINE,
    BLOCK_ARC,
    BLOCK_BLEND,
    BLOCK_DWELL,
    BLOCK_PINS,
    BLOCK_PAUSE
} block_kind_t;

// Squares of speeds as the planner counts them: integers, scaled so that the fastest speed the
// machine can have on any path lies just below V2_MAX. See planner_set_scale().
typedef uint32_t v2_t;
#define V2_MAX ((v2_t)1 << 31)

// The same rounded down to 12 binary digits, to fit in two bytes. Codes compare like what they
// stand for.
typedef uint16_t v2_code_t;
#define V2_CODE_MAX ((v2_code_t)(31u << 11)) // V2_MAX

#define PLANNER_GROUP 16u // binding entries

// Places along the path, in 2^-12 units and modulo 2^32: for differences.
#define WAY_ONE 4096.0f

// Outputs that are switched at a place of the queue.
typedef struct {
    uint32_t set, clear;  // masks
    uint32_t dwell_ticks; // to wait behind it
    uint8_t turn;         // of the spindle from now on, stepper_turn_t
} block_pins_t;

// Lengths and speeds along a move count all four axes, in units (mm and degrees) and units/s.
typedef struct {
    block_kind_t kind : 3;
    bool dims : 1;      // a laser's level follows the speed; moves
    uint32_t plane : 3; // of an arc: arc_plane_of()
    bool binds : 1;     // its entry cap is below what the block before it may do anyway
    uint8_t span_jerk;  // limits between the binding entry before this one and here
    uint16_t span_acceleration;
    uint32_t way;   // where it begins along the path
    uint64_t climb; // v2_t that all moves before it can gain: the sum of 2 * acceleration * length
    uint16_t line;  // lines_code()
    uint16_t level; // of the spindle's PWM from its beginning on; all but BLOCK_PAUSE
    union {
        struct {
            int32_t target[AXIS_COUNT]; // steps, where the move ends as it was programmed
            float length;               // units, > 0, of what is left of it between blends
            float axes_speed;           // units/s, the most that the axes allow
            float feed;         // units/s, as programmed; 0: rapid, as fast as the axes allow
            float acceleration; // units/s^2
            float jerk;         // units/s^3; 0: trapezoid
            v2_code_t corner;   // speed that the corner before it allows
            v2_code_t
                entry_cap; // the same, within what is allowed on both sides of the corner; main
            union {
                struct {
                    // What the blends before and behind it cut off, in 2^-32 of the programmed
                    // line.
                    uint32_t lead_in, lead_out;
                } line;
                struct {
                    int32_t centre[2]; // 2^-scale units from the start, along the axes of the plane
                    uint32_t scale : 5;
                    uint32_t clockwise : 1;
                    uint32_t several : 1; // turns count in 2^-18 of one, not in 2^-25
                    uint32_t turns : 25;
                } arc;
            };
        } move;
        uint32_t dwell_ticks;
        block_pins_t pins;
    };
} block_t;

// Factors on the programmed feed and on the rapid speed, 1: as they are.
typedef struct {
    float feed, rapid;
} planner_override_t;

// The blocks whose entry cap binds: none of the later ones makes the machine slower there anyway.
// In the order of the path, see planner.c.
typedef struct {
    uint32_t first, count; // index of the nearest one
    uint64_t last_key;     // of the farthest one, see planner.c; main
    // The least of each group of neighbours; below that where entries have been taken away.
    v2_t group_cap[STEPPER_BLOCKS_MAX / PLANNER_GROUP];
    span_t group_span[STEPPER_BLOCKS_MAX / PLANNER_GROUP];
    uint16_t slot[STEPPER_BLOCKS_MAX];
    v2_t cap[STEPPER_BLOCKS_MAX];
} binding_t;

typedef struct {
    ring_t ring;
    block_t slots[STEPPER_BLOCKS_MAX];
    binding_t binding;
    // Behind the newest block.
    uint32_t end_way;
    uint64_t end_climb;
    span_t end_span;
    bool front_started; // the governor has begun with the front block
    float v2_unit;      // (units/s)^2 of one v2_t step
    float v2_per_unit;  // 1 / v2_unit
    planner_override_t override;
    uint32_t overrides;         // changes of it
    volatile uint32_t executed; // blocks that are done; governor
} planner_ring_t;

extern planner_ring_t blocks;

// Empties the ring and gives it `size` slots; overrides stay. moves_set_position() has to follow.
// Context: main with the governor locked.
void planner_reset(uint32_t size);

// Recomputes the speed scale after the axes changed. Context: main, ring empty.
void planner_set_scale(void);

// Plans the whole ring anew with these overrides. Context: main.
void planner_set_override(const planner_override_t *override);

// The most that is allowed anywhere on the move now, units/s. Contexts: main, governor.
float planner_top_speed(const block_t *move);

static inline bool block_is_move(const block_t *block) {
    return block->kind <= BLOCK_BLEND;
}

// One whose level is in force while it is executed, and not only where it begins.
static inline bool block_has_level(const block_t *block) {
    return block->kind <= BLOCK_DWELL;
}

// ---- For new blocks, in moves.c. Context: main --------------------------------------------------

// The square of a speed as the planner counts it. Any context.
v2_t planner_v2(float speed2);

v2_code_t planner_v2_code(float speed2);

// The n-th free slot, to be filled in; and the newest block that is queued.
block_t *planner_free_slot(uint32_t n);
block_t *planner_newest(void);

// Puts the next `count` slots, which are filled in, behind all others: finds their entry caps,
// then, with the governor locked, plans and publishes them.
void planner_find_caps(uint32_t count);
void planner_publish(uint32_t count);

// The newest block is only that long from now on. Governor locked, nothing was based on its end.
void planner_shorten(float length);

// ---- For the governor ---------------------------------------------------------------------------

// The block to execute and the one behind it, NULL if there is none.
const block_t *planner_front(void);
const block_t *planner_second(void);

// The front block is executed from now on; later it is done.
void planner_start(void);
void planner_release(void);
void planner_release_all(void);

// The speed with which braking alone allows to leave the front block, in (units/s)^2.
float planner_exit_speed2(void);

// The limits of one block.
span_t planner_span_of(const block_t *block);

#endif
