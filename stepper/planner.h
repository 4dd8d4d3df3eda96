// The block ring and the look-ahead over it. Inside stepper/ only.
// The main loop writes blocks and plans them; the governor reads and releases them.
#ifndef STEPPER_PLANNER_H
#define STEPPER_PLANNER_H

#include "stepper/stepper.h"

typedef enum { BLOCK_MOVE, BLOCK_DWELL, BLOCK_PINS } block_kind_t;

// Squares of speeds as the planner's passes use them: integers, scaled so that the fastest speed the
// machine can have on any path lies just below V2_MAX. See planner_set_scale().
typedef uint32_t v2_t;
#define V2_MAX ((v2_t)1 << 31)

// The path of a move is a straight line in X, Y, Z and A; lengths and speeds along it count all four,
// in units (mm and degrees) and units/s.
typedef struct {
    block_kind_t kind;
    union {
        struct {
            int32_t target[AXIS_COUNT]; // steps, where the move ends
            float length;               // units, > 0
            float axes_speed;           // units/s, the most that the axes allow
            float feed;         // units/s, as programmed; 0: rapid, as fast as the axes allow
            float acceleration; // units/s^2
            v2_t corner;        // speed that the corner before it allows
            v2_t entry_cap;     // the same, within what is allowed on both sides of the corner
            v2_t entry;         // planned speed at its start
            v2_t gain;          // 2 * acceleration * length
        } move;
        uint32_t dwell_ticks;
        struct {
            uint32_t set, clear;
        } pins;
    };
} block_t;

// Factors on the programmed feed and on the rapid speed, 1: as they are.
typedef struct {
    float feed, rapid;
} planner_override_t;

typedef struct {
    ring_t ring;
    block_t slots[STEPPER_BLOCKS_MAX];
    float v2_unit; // (units/s)^2 of one v2_t step
    planner_override_t override;
} planner_ring_t;

extern planner_ring_t blocks;

// Empties the ring and gives it `size` slots; overrides stay. Context: main with the governor locked.
void planner_reset(uint32_t size);

// Recomputes the speed scale after the axes changed. Context: main, ring empty.
void planner_set_scale(void);

// Says where the machine stands; the next move starts there. Context: main, ring empty.
void planner_set_position(const int32_t steps[AXIS_COUNT]);

// The end of the last queued move, unrounded, in units.
void planner_target(double target[AXIS_COUNT]);

void planner_set_junction_deviation(float deviation_mm);
float planner_junction_deviation(void);

// Plans the whole ring anew with these overrides. Context: main.
void planner_set_override(const planner_override_t *override);

// The most that is allowed anywhere on the move now, units/s. Contexts: main, governor.
float planner_top_speed(const block_t *move);

// Puts a move, whose target has been checked, behind all others and re-plans the ring. A move
// shorter than half a step of each axis is not queued: its way is part of the next one.
void planner_push_move(const stepper_move_t *move, const int32_t target_steps[AXIS_COUNT]);
void planner_push_dwell(uint32_t ticks);
void planner_push_pins(uint32_t set, uint32_t clear);

// The speed with which the governor may leave the block at `take_slot`, in (units/s)^2.
// Context: governor.
float planner_exit_speed2(void);

// The block to execute, NULL if there is none; and its release. Context: governor.
const block_t *planner_front(void);
void planner_release(void);

#endif
