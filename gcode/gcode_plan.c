// A checked line as a sequence of entries. Context: main loop.
#include "gcode/gcode_plan.h"

#include <math.h>

#include "gcode/gcode_arc.h"
#include "gcode/gcode_check.h"
#include "gcode/gcode_offsets.h"
#include "stepper/stepper_check.h"

// ---- Which steps --------------------------------------------------------------------------------

static uint32_t bit(step_t step) {
    return 1u << step;
}

// Lines and arcs take a new speed along without a stop; otherwise it needs an entry of its own.
static bool changes_speed(const line_t *line) {
    bool takes_along = line->moves && line->modal.motion <= MOTION_ARC_CCW;
    return line_has(line, WORD_S) && line->modal.spindle != STEPPER_SPINDLE_OFF && !takes_along;
}

static uint32_t steps_of_tool(const line_t *line, const gcode_state_t *before) {
    if (!line_has_group(line, GROUP_TOOL_CHANGE)) {
        return 0;
    }
    bool turns = before->modal.spindle != STEPPER_SPINDLE_OFF;
    return bit(STEP_TOOL) | (turns ? bit(STEP_TOOL_STOP) : 0);
}

static uint32_t steps_of_end(const line_t *line, const gcode_state_t *before) {
    const modal_t *modal = &line->modal;
    switch ((stop_t)line->stop) {
    case STOP_PAUSE:
        return bit(STEP_PAUSE);
    case STOP_OPTIONAL:
        return before->options.optional_stop ? bit(STEP_PAUSE) : 0;
    case STOP_END:
        return bit(STEP_END) | (modal->spindle != STEPPER_SPINDLE_OFF ? bit(STEP_END_SPINDLE) : 0) |
               (modal->flood || modal->mist ? bit(STEP_END_COOLANT) : 0);
    case STOP_NONE:
        break;
    }
    return 0;
}

static uint32_t steps_of_once(const line_t *line) {
    switch ((once_t)line->once) {
    case ONCE_DWELL:
        return bit(STEP_DWELL);
    case ONCE_HOME:
        return bit(STEP_HOME);
    case ONCE_GO_STORED:
        return bit(STEP_STORED) | ((line->words & WORDS_AXES) != 0 ? bit(STEP_VIA) : 0);
    default:
        return 0;
    }
}

uint32_t gcode_plan_steps(const line_t *line, const gcode_state_t *before) {
    uint32_t steps = 0;
    if (line->moves) {
        steps |= line_is_cycle(line) ? bit(STEP_CYCLE) : bit(STEP_MOTION);
    }
    if (line->once != ONCE_NONE) {
        steps |= steps_of_once(line);
    }
    if (line_has_group(line, GROUP_SPINDLE) || changes_speed(line)) {
        steps |= bit(STEP_SPINDLE);
    }
    if (line_has_group(line, GROUP_COOLANT)) {
        steps |= bit(STEP_COOLANT);
    }
    return steps | steps_of_tool(line, before) | steps_of_end(line, before);
}

// ---- Places -------------------------------------------------------------------------------------

static bool moves_origin(const line_t *line) {
    const uint32_t groups =
        1u << GROUP_SYSTEM | 1u << GROUP_TOOL_LENGTH | 1u << GROUP_ONCE | 1u << GROUP_STOP;
    return (line->groups & groups) != 0;
}

static double place_of(const line_t *line, const gcode_state_t *state, axis_id_t axis,
                       double from) {
    double value = line->value[axis];
    if (line->once == ONCE_MACHINE) {
        return value;
    }
    if (line->modal.relative) {
        return from + value;
    }
    return value +
           (moves_origin(line) ? gcode_offsets_of(state, &line->modal, axis) : state->offset[axis]);
}

static void find_target(const line_t *line, const gcode_state_t *state,
                        const double from[AXIS_COUNT], double target[AXIS_COUNT]) {
    uint32_t given = line->words;
    if (line_is_arc(line) && line->moves && state->options.arc_legacy) {
        given &= ~WORD_BIT(WORD_A);
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        target[axis] = (given >> axis) & 1 ? place_of(line, state, axis, from[axis]) : from[axis];
    }
}

// ---- Feed ---------------------------------------------------------------------------------------

// The way that F is about, from `from`: mm, or degrees if only A moves.
static err_t way_of(const gcode_entry_t *entry, const double from[AXIS_COUNT], double *way) {
    if (entry->kind == ENTRY_ARC) {
        return stepper_arc_way(from, &entry->arc, way);
    }
    const double *target = entry->arc.move.target;
    double squares = 0.0;
    for (axis_id_t axis = AXIS_X; axis <= AXIS_Z; axis++) {
        squares += (target[axis] - from[axis]) * (target[axis] - from[axis]);
    }
    *way = squares > 0.0 ? sqrt(squares) : fabs(target[AXIS_A] - from[AXIS_A]);
    return ERR_OK;
}

static bool turns_only(const gcode_entry_t *entry, const double from[AXIS_COUNT]) {
    const double *target = entry->arc.move.target;
    return target[AXIS_X] == from[AXIS_X] && target[AXIS_Y] == from[AXIS_Y] &&
           target[AXIS_Z] == from[AXIS_Z];
}

static err_t set_feed(const line_t *line, gcode_entry_t *entry, const double from[AXIS_COUNT]) {
    const modal_t *modal = &line->modal;
    stepper_move_t *move = &entry->arc.move;
    move->feed = modal->feed;
    if (modal->inverse_time && !move->rapid) {
        double way;
        err_t err = way_of(entry, from, &way);
        if (err != ERR_OK) {
            return err;
        }
        move->feed = fmin(fmax(way * line->value[WORD_F], GCODE_FEED_MIN), GCODE_FEED_MAX);
    } else if (modal->feed_in_inches && entry->kind != ENTRY_ARC && turns_only(entry, from)) {
        move->feed = modal->feed / GCODE_MM_PER_INCH; // degrees are the same in all units
    }
    return ERR_OK;
}

// ---- Entries ------------------------------------------------------------------------------------

err_t gcode_plan_motion(const line_t *line, const gcode_state_t *state,
                        const double from[AXIS_COUNT], gcode_entry_t *entry) {
    stepper_move_t *move = &entry->arc.move;
    err_t err = ERR_OK;
    entry->kind = ENTRY_MOVE;
    move->rapid = line->modal.motion == MOTION_RAPID;
    move->corner = line->modal.path.corner;
    move->blend_mm = line->modal.path.blend_mm;
    move->sets_spindle = line_has(line, WORD_S) && !line_has_group(line, GROUP_SPINDLE);
    move->spindle_rpm = line->modal.rpm;
    find_target(line, state, from, move->target);
    if (line_is_arc(line)) {
        entry->kind = ENTRY_ARC;
        err = gcode_arc_find(&entry->arc, line, state, from);
    } else if (line_is_probe(line)) {
        motion_t motion = (motion_t)line->modal.motion;
        entry->kind = ENTRY_PROBE;
        entry->probe.toward = motion == MOTION_PROBE_TO || motion == MOTION_PROBE_TO_MAYBE;
        entry->probe.error_if_none = motion == MOTION_PROBE_TO || motion == MOTION_PROBE_OFF;
    }
    return err == ERR_OK ? set_feed(line, entry, from) : err;
}

// On the way to a stored place: first as the line says, then there with the axes it names, or all.
static void find_stored(const line_t *line, const gcode_state_t *state,
                        const double from[AXIS_COUNT], bool via, gcode_entry_t *entry) {
    stepper_move_t *move = &entry->arc.move;
    uint32_t axes = line->words & WORDS_AXES;
    entry->kind = ENTRY_MOVE;
    *move = (stepper_move_t){.rapid = true, .corner = STEPPER_CORNER_EXACT};
    if (via) {
        find_target(line, state, from, move->target);
        return;
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        bool goes = axes != 0 ? (axes >> axis) & 1 : stepper_axis_configured(axis);
        move->target[axis] = goes ? state->stored[line->stored][axis] : from[axis];
    }
}

static void set_spindle(gcode_entry_t *entry, unsigned turn, double rpm) {
    entry->kind = ENTRY_SPINDLE;
    entry->spindle.turn = (stepper_turn_t)turn;
    entry->spindle.rpm = rpm;
}

static void set_coolant(gcode_entry_t *entry, bool flood, bool mist) {
    entry->kind = ENTRY_COOLANT;
    entry->coolant.flood = flood;
    entry->coolant.mist = mist;
}

static err_t make(step_t step, const gcode_plan_t *plan, const gcode_state_t *state,
                  const double from[AXIS_COUNT], gcode_entry_t *entry) {
    const line_t *line = &plan->line;
    const modal_t *modal = &line->modal;
    switch (step) {
    case STEP_TOOL_STOP:
    case STEP_END_SPINDLE:
        set_spindle(entry, STEPPER_SPINDLE_OFF, 0.0);
        break;
    case STEP_TOOL:
    case STEP_PAUSE:
        entry->kind = ENTRY_PAUSE;
        entry->tool = step == STEP_TOOL ? modal->tool : GCODE_NO_TOOL;
        break;
    case STEP_SPINDLE:
        set_spindle(entry, modal->spindle, modal->rpm);
        break;
    case STEP_COOLANT:
        set_coolant(entry, modal->flood, modal->mist);
        break;
    case STEP_END_COOLANT:
        set_coolant(entry, false, false);
        break;
    case STEP_DWELL:
        entry->kind = ENTRY_DWELL;
        entry->dwell.ms = line->value[WORD_P];
        entry->dwell.lit = modal->motion >= MOTION_FEED && modal->motion <= MOTION_ARC_CCW;
        break;
    case STEP_HOME:
        entry->kind = ENTRY_HOME;
        entry->axes = line->words & WORDS_LINEAR;
        break;
    case STEP_VIA:
    case STEP_STORED:
        find_stored(line, state, from, step == STEP_VIA, entry);
        break;
    case STEP_MOTION:
        return gcode_plan_motion(line, state, from, entry);
    case STEP_END:
        entry->kind = ENTRY_END;
        break;
    case STEP_CYCLE:
    case STEPS:
        break;
    }
    return ERR_OK;
}

err_t gcode_plan_begin(gcode_plan_t *plan, const gcode_state_t *before,
                       const double from[AXIS_COUNT]) {
    const line_t *line = &plan->line;
    if ((plan->steps & bit(STEP_CYCLE)) == 0) {
        return ERR_OK;
    }
    double offset[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        offset[axis] = gcode_offsets_of(before, &line->modal, axis);
    }
    bool first = before->modal.motion < MOTION_CYCLE_CHIPS;
    return gcode_cycle_begin(&plan->cycle, line, &before->cycle, first, from, offset);
}

err_t gcode_plan_next(gcode_plan_t *plan, const gcode_state_t *state, const double from[AXIS_COUNT],
                      gcode_entry_t *entry, bool *more) {
    *more = true;
    for (step_t step = 0; step < STEPS; step++) {
        if ((plan->steps & bit(step)) == 0) {
            continue;
        }
        if (step == STEP_CYCLE && gcode_cycle_next(&plan->cycle, entry)) {
            return ERR_OK;
        }
        plan->steps &= ~bit(step);
        if (step != STEP_CYCLE) {
            return make(step, plan, state, from, entry);
        }
    }
    *more = false;
    return ERR_OK;
}
