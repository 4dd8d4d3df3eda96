// Coordinate systems, G92, tool lengths and stored places: how lines change them. Context: main
// loop.
#include "gcode/gcode_offsets.h"

#include <string.h>

#define L_TOOL 1.0
#define L_HERE 20.0

static bool sets_from_here(const line_t *line) {
    return line->once == ONCE_SET && line->value[WORD_L] == L_HERE;
}

bool gcode_offsets_need_place(const line_t *line) {
    return line->once == ONCE_SHIFT || line->once == ONCE_STORE_G28 ||
           line->once == ONCE_STORE_G30 || sets_from_here(line);
}

static double tool_length(const modal_t *modal, axis_id_t axis) {
    return axis == AXIS_Z ? modal->tool_length_mm : 0.0;
}

static double shift_of(const gcode_state_t *state, const modal_t *modal, axis_id_t axis) {
    return modal->shifted ? state->shift[axis] : 0.0;
}

double gcode_offsets_of(const gcode_state_t *state, const modal_t *modal, axis_id_t axis) {
    return state->systems[modal->system][axis] + shift_of(state, modal, axis) +
           tool_length(modal, axis);
}

void gcode_offsets_sum(gcode_state_t *state) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        state->offset[axis] = gcode_offsets_of(state, &state->modal, axis);
    }
}

// G92: the place gets these coordinates. Those that G92.2 has suspended are forgotten.
static void set_shift(gcode_state_t *state, const line_t *line, bool was_shifted,
                      const double place[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double old = was_shifted ? state->shift[axis] : 0.0;
        bool given = line_has(line, (word_t)axis);
        double base = state->systems[state->modal.system][axis] + tool_length(&state->modal, axis);
        state->shift[axis] = given ? place[axis] - base - line->value[axis] : old;
    }
}

// G10.
static void set_table(gcode_state_t *state, const line_t *line, const double place[AXIS_COUNT]) {
    unsigned number = (unsigned)line->value[WORD_P];
    if (line->value[WORD_L] == L_TOOL) {
        state->tool_lengths_mm[number - 1] = line->value[WORD_Z];
        return;
    }
    double *system = state->systems[number > 0 ? number - 1 : state->modal.system];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (!line_has(line, (word_t)axis)) {
            continue;
        }
        double value = line->value[axis];
        if (sets_from_here(line)) {
            value = place[axis] - shift_of(state, &state->modal, axis) -
                    tool_length(&state->modal, axis) - value;
        }
        system[axis] = value;
    }
}

static void store(gcode_state_t *state, stored_t stored, const double place[AXIS_COUNT]) {
    memcpy(state->stored[stored], place, sizeof state->stored[stored]);
    state->has_stored[stored] = true;
}

// M2 and M30, as RS274/NGC has it: G54, G17, G90, G94, G1, spindle and coolant off. Units, feed,
// tool length and G92 stay.
static void end_program(modal_t *modal) {
    modal->motion = MOTION_FEED;
    modal->plane = PLANE_XY;
    modal->system = 0;
    modal->relative = false;
    modal->inverse_time = false;
    modal->spindle = STEPPER_SPINDLE_OFF;
    modal->flood = false;
    modal->mist = false;
}

void gcode_offsets_commit(gcode_state_t *state, const line_t *line,
                          const double place[AXIS_COUNT]) {
    bool was_shifted = state->modal.shifted;
    state->modal = line->modal;
    switch ((once_t)line->once) {
    case ONCE_SET:
        set_table(state, line, place);
        break;
    case ONCE_SHIFT:
        set_shift(state, line, was_shifted, place);
        break;
    case ONCE_SHIFT_CLEAR:
        memset(state->shift, 0, sizeof state->shift);
        break;
    case ONCE_STORE_G28:
        store(state, STORED_G28, place);
        break;
    case ONCE_STORE_G30:
        store(state, STORED_G30, place);
        break;
    default:
        break;
    }
    if (line->stop == STOP_END) {
        end_program(&state->modal);
    }
    gcode_offsets_sum(state);
}
