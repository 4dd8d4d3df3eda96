// The way of a move that is being executed. Context: governor.
//
// Line: a part of the way from one end to the other. Blend: the parabola between two places on the
// lines before and behind it, with the corner as its third point. Arc: the radius at its start,
// turned and, if need be, stretched evenly:
//   position - start = start radius * (cos - 1) + its perpendicular * sin + rest * progress
// `rest` is what rounding to steps leaves over at the end.
#include "stepper/path.h"

#include <stdlib.h>
#include <string.h>

#include "stepper/arc.h"
#include "stepper/axis.h"
#include "stepper/segment.h"
#include "stepper/trig.h"

#define FRACTION_ONE ((uint64_t)1 << 32)
// Both ends of an arc are rounded to steps, half a step at most.
#define ROUNDING_MAX (STEP_ONE + STEP_ONE / 16)

static struct {
    block_kind_t kind;
    int32_t from[AXIS_COUNT]; // steps, where the move before it ends as programmed
    int32_t to[AXIS_COUNT];   // and this one
    struct {
        uint32_t lead_in, lead_out; // 2^-32 of the programmed line
    } line;
    struct {
        int64_t before[AXIS_COUNT]; // 2^-32 steps, from its begin to the corner
        int64_t behind[AXIS_COUNT]; // and on to its end
    } blend;
    struct {
        axis_id_t axis[2];
        // Start radius and its perpendicular in the steps of each axis, times 2^(shift + 2).
        int32_t radius[2], perpendicular[2];
        uint32_t shift;
        int64_t start[2]; // radius in 2^-32 steps
        int64_t sweep;    // 2^-32 turns
        int32_t growth;   // of the radius up to the end, of TRIG_ONE
        int32_t rest[2];  // 2^-16 steps
    } arc;
} path;

// ---- Fractions ----------------------------------------------------------------------------------

// value * fraction * 2^-32
static int64_t part_of(int64_t value, uint32_t fraction) {
    int64_t high = (value >> 32) * fraction;
    return high + (int64_t)(((value & 0xffffffff) * (uint64_t)fraction) >> 32);
}

static double power_of_two(int exponent) {
    uint64_t bits = (uint64_t)(1023 + exponent) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

// `value`, which is positive, is below 2^result.
static int binary_size(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (int)(bits >> 23) - 126;
}

// ---- Arcs ---------------------------------------------------------------------------------------

// From the start, in 2^-32 steps, without `rest`.
static void arc_offset(uint32_t angle, int32_t growth, int64_t offset[2]) {
    trig_t turned = trig_sin_cos(angle);
    if (growth != 0) {
        turned.cos += (int32_t)(((int64_t)turned.cos * growth) >> 30);
        turned.sin += (int32_t)(((int64_t)turned.sin * growth) >> 30);
    }
    for (unsigned n = 0; n < 2; n++) {
        int64_t place = (int64_t)path.arc.radius[n] * turned.cos +
                        (int64_t)path.arc.perpendicular[n] * turned.sin;
        offset[n] = (place >> path.arc.shift) - path.arc.start[n];
    }
}

static void measure_radius(const block_t *block) {
    const double scale[2] = {
        axes[path.arc.axis[0]].config.steps_per_unit,
        axes[path.arc.axis[1]].config.steps_per_unit,
    };
    const int32_t *centre = block->move.arc.centre;
    // The longer part of the radius fills 30 bits in the steps of the finer axis.
    int32_t across = abs(centre[0]) > abs(centre[1]) ? abs(centre[0]) : abs(centre[1]);
    float longest = (float)across * (float)(scale[0] > scale[1] ? scale[0] : scale[1]);
    int size = binary_size(longest) - (int)block->move.arc.scale; // steps below 2^size
    path.arc.shift = (uint32_t)(28 - size);
    double to_mantissa = power_of_two(30 - size - (int)block->move.arc.scale);
    double factor = scale[0] * to_mantissa;
    path.arc.radius[0] = -(int32_t)(centre[0] * factor);
    path.arc.perpendicular[0] = (int32_t)(centre[1] * factor);
    factor = scale[1] * to_mantissa;
    path.arc.radius[1] = -(int32_t)(centre[1] * factor);
    path.arc.perpendicular[1] = -(int32_t)(centre[0] * factor);
    for (unsigned n = 0; n < 2; n++) {
        path.arc.start[n] = ((int64_t)path.arc.radius[n] * TRIG_ONE) >> path.arc.shift;
    }
}

// How far the arc's end is from where it should be, in 2^-32 steps.
static void find_rest(int64_t rest[2]) {
    int64_t offset[2];
    arc_offset((uint32_t)path.arc.sweep, path.arc.growth, offset);
    for (unsigned n = 0; n < 2; n++) {
        axis_id_t axis = path.arc.axis[n];
        rest[n] = ((int64_t)path.to[axis] - path.from[axis]) * STEP_ONE - offset[n];
    }
}

// Splits `rest` into turning on and stretching. Lengths in units.
static void turn_and_stretch(const int64_t rest[2]) {
    float left[2], radius[2];
    for (unsigned n = 0; n < 2; n++) {
        axis_id_t axis = path.arc.axis[n];
        float units = 1.0f / ((float)STEP_ONE * (float)axes[axis].config.steps_per_unit);
        int64_t end = ((int64_t)path.to[axis] - path.from[axis]) * STEP_ONE - rest[n];
        left[n] = (float)rest[n] * units;
        radius[n] = (float)(path.arc.start[n] + end) * units;
    }
    float radius2 = radius[0] * radius[0] + radius[1] * radius[1];
    float turn = radius[0] * left[1] - radius[1] * left[0];
    float stretch = radius[0] * left[0] + radius[1] * left[1];
    float most = 0.25f * radius2;
    if (turn < most && turn > -most && stretch < most && stretch > -most) {
        path.arc.sweep += (int64_t)(turn / radius2 * (float)(TRIG_TURN / 6.283185307179586));
        path.arc.growth = (int32_t)(stretch / radius2 * (float)TRIG_ONE);
    }
}

static void meet_end(void) {
    int64_t rest[2];
    find_rest(rest);
    // Rounding alone is each axis' own business.
    if (llabs(rest[0]) > ROUNDING_MAX || llabs(rest[1]) > ROUNDING_MAX) {
        turn_and_stretch(rest);
        find_rest(rest);
    }
    for (unsigned n = 0; n < 2; n++) {
        path.arc.rest[n] = (int32_t)(rest[n] >> 16);
    }
}

static void begin_arc(const block_t *block) {
    for (unsigned n = 0; n < 2; n++) {
        path.arc.axis[n] = arc_plane_axis(block->plane, n);
    }
    int64_t sweep = (int64_t)block->move.arc.turns << (block->move.arc.several ? 14 : 7);
    path.arc.sweep = block->move.arc.clockwise ? -sweep : sweep;
    path.arc.growth = 0;
    measure_radius(block);
    meet_end();
}

static void arc_at(uint32_t fraction, int64_t position[AXIS_COUNT]) {
    int64_t offset[2];
    uint32_t angle = (uint32_t)part_of(path.arc.sweep, fraction);
    arc_offset(angle, (int32_t)(((int64_t)path.arc.growth * fraction) >> 32), offset);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t delta = (int64_t)path.to[axis] - path.from[axis];
        position[axis] = path.from[axis] * STEP_ONE;
        bool turns = axis == path.arc.axis[0] || axis == path.arc.axis[1];
        if (delta != 0 && !turns) {
            position[axis] += delta * fraction;
        }
    }
    for (unsigned n = 0; n < 2; n++) {
        position[path.arc.axis[n]] += offset[n] + (((int64_t)path.arc.rest[n] * fraction) >> 16);
    }
}

// ---- Lines and blends ---------------------------------------------------------------------------

static void begin_line(const block_t *block) {
    path.line.lead_in = block->move.line.lead_in;
    path.line.lead_out = block->move.line.lead_out;
}

static void line_at(uint64_t along, int64_t position[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t delta = (int64_t)path.to[axis] - path.from[axis];
        position[axis] = path.from[axis] * STEP_ONE + delta * (int64_t)along;
    }
}

// The line before the blend is still in `path`; the one behind it is the next block.
static void begin_blend(void) {
    const block_t *next = planner_second();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t delta = (int64_t)path.to[axis] - path.from[axis];
        path.blend.before[axis] = delta * path.line.lead_out;
        delta = (int64_t)next->move.target[axis] - path.to[axis];
        path.blend.behind[axis] = delta * next->move.line.lead_in;
    }
}

static void blend_at(uint32_t fraction, int64_t position[AXIS_COUNT]) {
    uint64_t left = FRACTION_ONE - 1 - fraction;
    uint32_t left2 = (uint32_t)((left * left) >> 32);
    uint32_t fraction2 = (uint32_t)(((uint64_t)fraction * fraction) >> 32);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        position[axis] = path.to[axis] * STEP_ONE;
        if (path.blend.before[axis] != 0) {
            position[axis] -= part_of(path.blend.before[axis], left2);
        }
        if (path.blend.behind[axis] != 0) {
            position[axis] += part_of(path.blend.behind[axis], fraction2);
        }
    }
}

// ---- Any move -----------------------------------------------------------------------------------

void path_stand(const int32_t steps[AXIS_COUNT]) {
    path.kind = BLOCK_DWELL;
    memcpy(path.to, steps, sizeof path.to);
}

void path_begin(const block_t *block) {
    path.kind = block->kind;
    if (block->kind == BLOCK_BLEND) {
        begin_blend();
        return; // the corner stays the end of the line before it
    }
    memcpy(path.from, path.to, sizeof path.from);
    memcpy(path.to, block->move.target, sizeof path.to);
    if (block->kind == BLOCK_ARC) {
        begin_arc(block);
    } else {
        begin_line(block);
    }
}

void path_at(uint64_t progress, int64_t position[AXIS_COUNT]) {
    uint32_t fraction = (uint32_t)(progress >> 32);
    if (path.kind == BLOCK_ARC) {
        arc_at(fraction, position);
    } else if (path.kind == BLOCK_BLEND) {
        blend_at(fraction, position);
    } else {
        uint64_t span = FRACTION_ONE - path.line.lead_in - path.line.lead_out;
        line_at(path.line.lead_in + ((span * fraction) >> 32), position);
    }
}

void path_end(int64_t position[AXIS_COUNT]) {
    if (path.kind == BLOCK_LINE) {
        line_at(FRACTION_ONE - path.line.lead_out, position);
        return;
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        position[axis] = path.to[axis] * STEP_ONE;
        position[axis] += path.kind == BLOCK_BLEND ? path.blend.behind[axis] : 0;
    }
}
