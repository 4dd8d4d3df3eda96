// New entries of the block ring: what a move is like, how it follows the one before, and blends
// between lines. Context: main loop.
#include "stepper/moves.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "stepper/arc.h"
#include "stepper/axis.h"
#include "stepper/extremes.h"
#include "stepper/geometry.h"
#include "stepper/governor.h"
#include "stepper/lines.h"
#include "stepper/outputs.h"
#include "stepper/stepper_homing.h"

// A line, its blend and the next line, and one to spare.
#define BLEND_RING_MIN 4u

static struct {
    double commanded[AXIS_COUNT]; // end of the last move, units, also if it was too short to queue
    double target[AXIS_COUNT];    // end of the last queued move, units
    int32_t target_steps[AXIS_COUNT];
    bool corner; // the last queued block is a move, `last` is what it is like
    bool blends; // the last one is a line that may be rounded off at its end
    geometry_t last;
} moves;

void moves_set_position(const int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        moves.target_steps[axis] = steps[axis];
        moves.target[axis] = axis_from_steps(axis, steps[axis]);
        moves.commanded[axis] = moves.target[axis];
    }
    moves.corner = false;
}

void moves_target(double target[AXIS_COUNT]) {
    memcpy(target, moves.commanded, sizeof moves.commanded);
}

// Puts the block in the next slot, which is filled in, behind all others.
static void push_block(void) {
    planner_find_caps(1);
    hal_governor_lock();
    planner_publish(1);
    hal_governor_unlock();
}

// A laser burns in moves at a feed only, and not in those of homing and probing.
static __attribute__((noinline)) void set_beam(block_t *block) {
    bool burns = block->move.feed > 0.0f && stepper_cycle() == STEPPER_CYCLE_NONE;
    block->level = burns ? outputs.level : 0;
    block->dims = burns && outputs.turn == STEPPER_SPINDLE_CCW;
}

static void fill_move(block_t *block, const geometry_t *g, float corner2,
                      const int32_t target_steps[AXIS_COUNT]) {
    block->line = lines_code();
    block->level = outputs.level;
    memcpy(block->move.target, target_steps, sizeof block->move.target);
    block->move.length = g->length;
    block->move.axes_speed = g->axes_speed;
    block->move.feed = g->feed;
    block->move.acceleration = g->acceleration;
    block->move.jerk = g->jerk;
    block->move.corner = planner_v2_code(corner2);
    if (outputs.laser) {
        set_beam(block);
    }
}

// ---- Blends -------------------------------------------------------------------------------------

// The newest block is a line that nobody has begun to follow; the corner behind it may still be
// changed.
static bool may_shorten(void) {
    uint32_t used = ring_used(&blocks.ring);
    return moves.corner && moves.blends && blocks.ring.size >= BLEND_RING_MIN &&
           (used > 1 || (used == 1 && !blocks.front_started));
}

uint32_t moves_free(void) {
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

// Whether the machine can still stop before the newest line ends, if that is `length` long. Only
// then may its end be changed: what is done already does not depend on anything behind it.
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
    v2_t gain = planner_v2(2.0f * line->move.acceleration * length);
    return overrun2 <= 0.0f || planner_v2(overrun2) < line->climb - second->climb + gain;
}

// Cuts `lead` in 2^-32 off the end of the newest block, a line. False: it is too late for that.
// Governor locked.
static bool shorten(uint32_t lead) {
    block_t *line = planner_newest();
    float rest = geometry_part(&moves.last, line->move.line.lead_in, lead);
    if (!may_shorten() || !is_far_ahead(line, rest)) {
        return false;
    }
    line->move.line.lead_out = lead;
    planner_shorten(rest);
    return true;
}

// A corner is burnt by the weaker of both lines, so not at all next to a rapid one.
static void dim_blend(block_t *blend, const block_t *line) {
    uint16_t before = planner_newest()->level;
    blend->level = before < line->level ? before : line->level;
}

// Rounds the corner to the new line `g` off: a block for the parabola and one for what is left of
// the line. False if that is not possible or no use.
static bool push_blended(const geometry_t *g, const stepper_move_t *move,
                         const int32_t target_steps[AXIS_COUNT]) {
    geometry_t curve;
    float reach;
    if (move->corner != STEPPER_CORNER_BLEND || !may_shorten() || ring_free(&blocks.ring) < 2 ||
        !geometry_blend(&curve, &moves.last, g, (float)move->blend_mm, &reach)) {
        return false;
    }
    block_t *blend = planner_free_slot(0);
    block_t *line = planner_free_slot(1);
    *blend = (block_t){.kind = BLOCK_BLEND};
    fill_move(blend, &curve, FLT_MAX, moves.target_steps);
    *line = (block_t){.kind = BLOCK_LINE};
    fill_move(line, g, FLT_MAX, target_steps);
    line->move.line.lead_in = geometry_fraction(g, reach);
    line->move.length = geometry_part(g, line->move.line.lead_in, 0);
    if (outputs.laser) {
        dim_blend(blend, line);
    }
    planner_find_caps(2);
    hal_governor_lock();
    bool done = shorten(geometry_fraction(&moves.last, reach));
    if (done) {
        planner_publish(2);
    }
    hal_governor_unlock();
    return done;
}

// ---- New moves ----------------------------------------------------------------------------------

// The move `g` is queued; the next one starts behind it.
static void follow_move(const geometry_t *g, const stepper_move_t *move,
                        const int32_t target_steps[AXIS_COUNT]) {
    memcpy(moves.target, move->target, sizeof moves.target);
    memcpy(moves.target_steps, target_steps, sizeof moves.target_steps);
    moves.last = *g;
    moves.corner = true;
}

static void find_delta(double delta[AXIS_COUNT], const stepper_move_t *move) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        delta[axis] = move->target[axis] - moves.target[axis];
    }
}

static float corner_before(const geometry_t *g, const stepper_move_t *move) {
    return moves.corner ? geometry_corner_speed2(&moves.last, g, move->corner) : 0.0f;
}

static bool ends_where_it_starts(const int32_t target_steps[AXIS_COUNT]) {
    return memcmp(target_steps, moves.target_steps, sizeof moves.target_steps) == 0;
}

bool moves_push_line(const stepper_move_t *move, const int32_t target_steps[AXIS_COUNT]) {
    memcpy(moves.commanded, move->target, sizeof moves.commanded);
    if (ends_where_it_starts(target_steps)) {
        return false;
    }
    double delta[AXIS_COUNT];
    find_delta(delta, move);
    geometry_t g;
    geometry_line(&g, delta, move);
    geometry_even_out(&g);
    if (!push_blended(&g, move, target_steps)) {
        block_t *block = planner_free_slot(0);
        *block = (block_t){.kind = BLOCK_LINE};
        fill_move(block, &g, corner_before(&g, move), target_steps);
        push_block();
    }
    follow_move(&g, move, target_steps);
    moves.blends = move->corner == STEPPER_CORNER_BLEND;
    return true;
}

bool moves_push_arc(const arc_t *arc, const stepper_move_t *move,
                    const int32_t target_steps[AXIS_COUNT]) {
    memcpy(moves.commanded, move->target, sizeof moves.commanded);
    if (ends_where_it_starts(target_steps) && arc_is_below_a_step(arc)) {
        return false;
    }
    double delta[AXIS_COUNT];
    find_delta(delta, move);
    geometry_t g;
    arc_geometry(&g, arc, delta, move);
    block_t *block = planner_free_slot(0);
    *block = (block_t){.kind = BLOCK_ARC};
    arc_fill(block, arc);
    fill_move(block, &g, corner_before(&g, move), target_steps);
    push_block();
    follow_move(&g, move, target_steps);
    moves.blends = false;
    return true;
}

// Puts the block in the next slot, at which the machine stands, behind all others.
static void push_standing(void) {
    planner_free_slot(0)->line = lines_code();
    moves.corner = false;
    push_block();
}

void moves_push_dwell(uint32_t ticks, bool lit) {
    bool dark = outputs.laser && !(lit && outputs.turn == STEPPER_SPINDLE_CW);
    *planner_free_slot(0) = (block_t){
        .kind = BLOCK_DWELL,
        .level = dark ? 0 : outputs.level,
        .dwell_ticks = ticks,
    };
    push_standing();
}

void moves_push_pins(const block_pins_t *pins) {
    uint16_t level = outputs.laser ? 0 : outputs.level;
    *planner_free_slot(0) = (block_t){.kind = BLOCK_PINS, .level = level, .pins = *pins};
    push_standing();
}

void moves_push_pause(void) {
    *planner_free_slot(0) = (block_t){.kind = BLOCK_PAUSE};
    push_standing();
}
