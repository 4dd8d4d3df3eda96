// The machine's interpreter and what others may ask it. Context: main loop.
#include "gcode/gcode.h"

#include <string.h>

#include "gcode/gcode_interpreter.h"
#include "gcode/gcode_offsets.h"
#include "stepper/rules.h"

gcode_interpreter_t gcode_live = {.sink = &gcode_machine};

static err_t check_initialized(void) {
    return stepper_active() < 0 ? rules_check(RULES_DO_GCODE) : ERR_OK; // the rule is short
}

err_t gcode_line(const char *text, size_t length) {
    err_t err = check_initialized();
    return err == ERR_OK ? gcode_interpreter_line(&gcode_live, text, length) : err;
}

err_t gcode_words(const gcode_word_t *words, size_t count) {
    err_t err = check_initialized();
    return err == ERR_OK ? gcode_interpreter_words(&gcode_live, words, count) : err;
}

void gcode_background(void) {
    gcode_interpreter_background(&gcode_live);
}

bool gcode_busy(void) {
    return gcode_live.busy;
}

bool gcode_must_wait(void) {
    return gcode_live.waits;
}

err_t gcode_failure(void) {
    return gcode_interpreter_failure(&gcode_live);
}

bool gcode_failed(void) {
    return gcode_live.failure.code != ERR_OK;
}

bool gcode_take_end(void) {
    bool ended = gcode_live.ended;
    gcode_live.ended = false;
    return ended;
}

// ---- State --------------------------------------------------------------------------------------

void gcode_reset_modal(void) {
    gcode_state_t *state = &gcode_live.state;
    state->modal = (modal_t){
        .system = state->modal.system,
        .shifted = state->modal.shifted,
        .spindle = state->modal.spindle,
        .flood = state->modal.flood,
        .mist = state->modal.mist,
        .rpm = state->modal.rpm,
        .tool_length_mm = state->modal.tool_length_mm,
        .tool = state->modal.tool,
        .next_tool = state->modal.next_tool,
    };
    gcode_live.busy = false;
    gcode_live.waits = false;
}

void gcode_clear_offsets(void) {
    memset(gcode_live.state.shift, 0, sizeof gcode_live.state.shift);
    gcode_live.state.modal.shifted = false;
    gcode_offsets_sum(&gcode_live.state);
}

void gcode_reset(void) {
    gcode_state_t *state = &gcode_live.state;
    state->modal = (modal_t){.tool_length_mm = state->modal.tool_length_mm};
    state->options = (gcode_options_t){0};
    gcode_live.busy = false;
    gcode_live.waits = false;
    gcode_live.ended = false;
    gcode_live.failure.code = ERR_OK;
    gcode_clear_offsets();
}

const gcode_options_t *gcode_options(void) {
    return &gcode_live.state.options;
}

void gcode_set_options(const gcode_options_t *options) {
    gcode_live.state.options = *options;
}

gcode_path_t gcode_path(void) {
    return gcode_live.state.modal.path;
}

double gcode_offset(axis_id_t axis) {
    return gcode_live.state.offset[axis];
}

double gcode_work_position(axis_id_t axis) {
    return stepper_position(axis) - gcode_live.state.offset[axis];
}
