// Modal state and execution. A line is read whole, checked whole, carried out as at most one entry of
// the motion queue, and only then does it change the modal state. Context: main loop.
#include "gcode/gcode.h"

#include <math.h>
#include <string.h>

#include "gcode/gcode_lexer.h"

// units/min; slower than any machine, and faster than the axes will allow.
#define FEED_MIN 0.001
#define FEED_MAX 1.0e9

typedef enum { MOTION_NONE, MOTION_RAPID, MOTION_FEED } motion_t;

typedef struct {
    motion_t motion;
    bool relative;
    double feed; // units/min, 0: not set
} modal_t;

static struct {
    modal_t modal;
    double offset[AXIS_COUNT];
} gcode;

// What a line asks for, besides its axis words and parameters.
typedef enum {
    ACTION_NONE,
    ACTION_MOVE,
    ACTION_DWELL,
    ACTION_HOME,
    ACTION_OFFSET,
    ACTION_SPINDLE
} action_t;

typedef struct {
    action_t action;
    bool spindle_on;
    bool motion_given;
    bool distance_given;
    modal_t modal; // as it will be after the line
    uint32_t axes; // bit n: axis n has a word
    double axis[AXIS_COUNT];
    bool has_feed;
    bool has_p;
    double p;
} line_t;

// ---- Reading -------------------------------------------------------------------------------------

static err_t set_action(line_t *line, action_t action) {
    if (line->action != ACTION_NONE) {
        return err_raise(ERR_GCODE_ONE_ACTION, NULL);
    }
    line->action = action;
    return ERR_OK;
}

static err_t set_motion(line_t *line, motion_t motion) {
    if (line->motion_given) {
        return err_raise(ERR_GCODE_CONFLICT, "motion modes");
    }
    line->motion_given = true;
    line->modal.motion = motion;
    return ERR_OK;
}

static err_t set_distance(line_t *line, bool relative) {
    if (line->distance_given) {
        return err_raise(ERR_GCODE_CONFLICT, "distance modes");
    }
    line->distance_given = true;
    line->modal.relative = relative;
    return ERR_OK;
}

static err_t unsupported(const gcode_word_t *word) {
    return err_raise(ERR_GCODE_UNSUPPORTED, "%c%g", word->letter, word->value);
}

// The number of a G or M word as an integer, -1 if it is none (G92.1) or out of reach.
static int code_number(const gcode_word_t *word) {
    return word->value >= 0.0 && word->value < 1000.0 && word->value == floor(word->value)
               ? (int)word->value
               : -1;
}

static err_t read_g(line_t *line, const gcode_word_t *word) {
    switch (code_number(word)) {
    case 0:
        return set_motion(line, MOTION_RAPID);
    case 1:
        return set_motion(line, MOTION_FEED);
    case 4:
        return set_action(line, ACTION_DWELL);
    case 28:
        return set_action(line, ACTION_HOME);
    case 90:
        return set_distance(line, false);
    case 91:
        return set_distance(line, true);
    case 92:
        return set_action(line, ACTION_OFFSET);
    default:
        return unsupported(word);
    }
}

static err_t read_m(line_t *line, const gcode_word_t *word) {
    switch (code_number(word)) {
    case 3:
        line->spindle_on = true;
        return set_action(line, ACTION_SPINDLE);
    case 5:
        line->spindle_on = false;
        return set_action(line, ACTION_SPINDLE);
    default:
        return unsupported(word);
    }
}

static err_t twice(char letter) {
    return err_raise(ERR_GCODE_TWICE, "%c", letter);
}

static err_t read_axis(line_t *line, axis_id_t axis, double value) {
    if ((line->axes >> axis) & 1) {
        return twice(STEPPER_AXIS_LETTERS[axis]);
    }
    if (!stepper_axis_configured(axis)) {
        return err_raise(ERR_AXIS_NOT_CONFIGURED, "%c", STEPPER_AXIS_LETTERS[axis]);
    }
    line->axes |= 1u << axis;
    line->axis[axis] = value;
    return ERR_OK;
}

static err_t read_feed(line_t *line, double value) {
    if (line->has_feed) {
        return twice('F');
    }
    if (!(value >= FEED_MIN && value <= FEED_MAX)) {
        return err_raise(ERR_GCODE_RANGE, "F: %g is invalid (valid is %g to %g)", value, FEED_MIN,
                         FEED_MAX);
    }
    line->has_feed = true;
    line->modal.feed = value;
    return ERR_OK;
}

static err_t read_p(line_t *line, double value) {
    if (line->has_p) {
        return twice('P');
    }
    if (!(value >= 0.0 && value <= STEPPER_DWELL_MAX_MS)) {
        return err_raise(ERR_GCODE_RANGE, "P: %g is invalid (valid is 0 to %.0f)", value,
                         STEPPER_DWELL_MAX_MS);
    }
    line->has_p = true;
    line->p = value;
    return ERR_OK;
}

static err_t read_word(line_t *line, const gcode_word_t *word) {
    static const char letters[] = STEPPER_AXIS_LETTERS;
    const char *axis = memchr(letters, word->letter, AXIS_COUNT);
    if (axis != NULL) {
        return read_axis(line, (axis_id_t)(axis - letters), word->value);
    }
    switch (word->letter) {
    case 'G':
        return read_g(line, word);
    case 'M':
        return read_m(line, word);
    case 'F':
        return read_feed(line, word->value);
    case 'P':
        return read_p(line, word->value);
    default:
        return err_raise(ERR_GCODE_UNKNOWN_WORD, "%c", word->letter);
    }
}

// What the words mean together.
static err_t check_combination(line_t *line) {
    if (line->has_p && line->action != ACTION_DWELL) {
        return err_raise(ERR_GCODE_P_ALONE, NULL);
    }
    switch (line->action) {
    case ACTION_NONE:
        if (line->axes != 0) {
            line->action = ACTION_MOVE;
        }
        return ERR_OK;
    case ACTION_DWELL:
        if (!line->has_p) {
            return err_raise(ERR_GCODE_DWELL_P, NULL);
        }
        return line->axes != 0 ? err_raise(ERR_GCODE_ONE_ACTION, NULL) : ERR_OK;
    case ACTION_OFFSET:
        if (line->axes == 0) {
            return err_raise(ERR_GCODE_OFFSET_AXIS, NULL);
        }
        return line->motion_given ? err_raise(ERR_GCODE_ONE_ACTION, NULL) : ERR_OK;
    case ACTION_SPINDLE:
        return line->axes != 0 ? err_raise(ERR_GCODE_ONE_ACTION, NULL) : ERR_OK;
    case ACTION_HOME:
        return err_raise(ERR_GCODE_NO_HOMING, NULL);
    case ACTION_MOVE:
        break;
    }
    return ERR_OK;
}

// ---- Carrying out --------------------------------------------------------------------------------

static err_t move(const line_t *line) {
    if (line->modal.motion == MOTION_NONE) {
        return err_raise(ERR_GCODE_NO_MOTION, NULL);
    }
    if (line->modal.motion == MOTION_FEED && line->modal.feed <= 0.0) {
        return err_raise(ERR_GCODE_NO_FEED, NULL);
    }
    stepper_move_t wanted = {.feed = line->modal.feed, .rapid = line->modal.motion == MOTION_RAPID};
    stepper_target(wanted.target);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((line->axes >> axis) & 1) {
            wanted.target[axis] = line->axis[axis] +
                                  (line->modal.relative ? wanted.target[axis] : gcode.offset[axis]);
        }
    }
    return stepper_move(&wanted);
}

// G92: the last commanded position gets these coordinates; moves that wait keep their way.
static err_t set_offsets(const line_t *line) {
    stepper_status_t status;
    stepper_status(&status);
    if (!status.position_known || status.stopping) {
        return err_raise(status.stopping ? ERR_STEPPER_STOPPING : ERR_POSITION_UNKNOWN, NULL);
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
        return stepper_spindle_switch(line->spindle_on);
    case ACTION_NONE:
    case ACTION_HOME:
        break;
    }
    return ERR_OK;
}

err_t gcode_words(const gcode_word_t *words, size_t count) {
    if (stepper_active() < 0) {
        return err_raise(ERR_STEPPER_NOT_INITIALIZED, NULL);
    }
    line_t line = {.modal = gcode.modal};
    err_t err = ERR_OK;
    for (size_t i = 0; i < count && err == ERR_OK; i++) {
        err = read_word(&line, &words[i]);
    }
    if (err == ERR_OK) {
        err = check_combination(&line);
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
}

double gcode_offset(axis_id_t axis) {
    return gcode.offset[axis];
}
