// Modal state and execution. A line is read whole, checked whole, carried out as at most one move
// or other entry of the motion queue, and only then does it change the modal state. Context: main
// loop.
#include "gcode/gcode.h"

#include <string.h>

#include "gcode/gcode_arc.h"
#include "gcode/gcode_lexer.h"
#include "gcode/gcode_words.h"
#include "stepper/rules.h"
#include "stepper/stepper_outputs.h"

static struct {
    modal_t modal;
    double offset[AXIS_COUNT];
    bool arc_legacy; // A words of arcs are ignored
} gcode;

// ---- Carrying out -------------------------------------------------------------------------------

static void find_move(stepper_move_t *wanted, const line_t *line) {
    *wanted = (stepper_move_t){
        .feed = line->modal.feed,
        .rapid = line->modal.motion == MOTION_RAPID,
        .corner = line->modal.path.corner,
        .blend_mm = line->modal.path.blend_mm,
    };
    uint32_t given = line->axes;
    if (line_is_arc(line) && gcode.arc_legacy) {
        given &= ~(1u << AXIS_A);
    }
    stepper_target(wanted->target);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((given >> axis) & 1) {
            wanted->target[axis] = line->axis[axis] + (line->modal.relative ? wanted->target[axis]
                                                                            : gcode.offset[axis]);
        }
    }
}

static err_t move(const line_t *line) {
    if (line->modal.motion == MOTION_NONE) {
        return err_raise(ERR_GCODE_NO_MOTION, NULL);
    }
    if (line->modal.motion != MOTION_RAPID && line->modal.feed <= 0.0) {
        return err_raise(ERR_GCODE_NO_FEED, NULL);
    }
    stepper_arc_t wanted = {.turns = line->has_p ? (uint32_t)line->p : 1};
    find_move(&wanted.move, line);
    if (!line_is_arc(line)) {
        return stepper_move(&wanted.move);
    }
    err_t err = gcode_arc_find(&wanted, line);
    return err == ERR_OK ? stepper_arc(&wanted) : err;
}

// G92: the last commanded position gets these coordinates; moves that wait keep their way.
static err_t set_offsets(const line_t *line) {
    err_t err = rules_check(RULES_DO_OFFSET);
    if (err != ERR_OK) {
        return err;
    }
    double target[AXIS_COUNT];
    stepper_target(target);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((line->axes >> axis) & 1) {
            gcode.offset[axis] = target[axis] - line->axis[axis];
        }
    }
    return ERR_OK;
}

static err_t carry_out(const line_t *line) {
    switch (line->action) {
    case ACTION_MOVE:
        return move(line);
    case ACTION_DWELL:
        return stepper_dwell(line->p);
    case ACTION_OFFSET:
        return set_offsets(line);
    case ACTION_SPINDLE:
        return stepper_spindle_switch(line->spindle_on ? STEPPER_SPINDLE_CW : STEPPER_SPINDLE_OFF,
                                      0.0);
    case ACTION_NONE:
    case ACTION_HOME:
        break;
    }
    return ERR_OK;
}

err_t gcode_words(const gcode_word_t *words, size_t count) {
    line_t line;
    err_t err = rules_check(RULES_DO_GCODE);
    if (err == ERR_OK) {
        err = gcode_words_read(&line, &gcode.modal, words, count);
    }
    if (err == ERR_OK) {
        err = carry_out(&line);
    }
    if (err == ERR_OK) {
        gcode.modal = line.modal;
    }
    return err;
}

err_t gcode_line(const char *text, size_t length) {
    gcode_word_t words[GCODE_WORDS_MAX];
    size_t count;
    err_t err = gcode_lexer_split(text, length, words, &count);
    return err == ERR_OK ? gcode_words(words, count) : err;
}

void gcode_reset_modal(void) {
    gcode.modal = (modal_t){.motion = MOTION_NONE};
}

void gcode_clear_offsets(void) {
    memset(gcode.offset, 0, sizeof gcode.offset);
}

void gcode_reset(void) {
    gcode_reset_modal();
    gcode_clear_offsets();
    gcode.arc_legacy = false;
}

void gcode_set_arc_legacy(bool legacy) {
    gcode.arc_legacy = legacy;
}

bool gcode_arc_legacy(void) {
    return gcode.arc_legacy;
}

gcode_plane_t gcode_plane(void) {
    return gcode.modal.plane;
}

gcode_path_t gcode_path(void) {
    return gcode.modal.path;
}

double gcode_offset(axis_id_t axis) {
    return gcode.offset[axis];
}
