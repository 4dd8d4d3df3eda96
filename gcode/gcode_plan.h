// A checked line as a sequence of entries, in RS274/NGC's order of execution. Inside gcode/ only.
// Context: main loop.
#ifndef GCODE_PLAN_H
#define GCODE_PLAN_H

#include "gcode/gcode_cycle.h"

// In this order.
typedef enum {
    STEP_TOOL_STOP, // the spindle stops before the tool is changed
    STEP_TOOL,
    STEP_SPINDLE,
    STEP_COOLANT,
    STEP_DWELL,
    STEP_HOME,
    STEP_VIA,    // to the intermediate point of G28 or G30
    STEP_STORED, // and on to the stored place
    STEP_MOTION,
    STEP_CYCLE,
    STEP_END_SPINDLE,
    STEP_END_COOLANT,
    STEP_PAUSE,
    STEP_END,
    STEPS
} step_t;

typedef struct {
    uint32_t steps; // bit n: step n is still to be done
    line_t line;
    gcode_cycle_t cycle; // with STEP_CYCLE
} gcode_plan_t;

// The steps of a line as bits; `before` is the state before it.
uint32_t gcode_plan_steps(const line_t *line, const gcode_state_t *before);

// Begins a plan whose line and steps are filled in, at `from`. Errors: of cycles.
err_t gcode_plan_begin(gcode_plan_t *plan, const gcode_state_t *before,
                       const double from[AXIS_COUNT]);

// The next entry, when all before it end at `from`. `state` is that before the line, or the one
// behind it. *more: there is one. Errors: of arcs.
err_t gcode_plan_next(gcode_plan_t *plan, const gcode_state_t *state, const double from[AXIS_COUNT],
                      gcode_entry_t *entry, bool *more);

// The line, arc or probing move of a line, from `from`.
err_t gcode_plan_motion(const line_t *line, const gcode_state_t *state,
                        const double from[AXIS_COUNT], gcode_entry_t *entry);

#endif
