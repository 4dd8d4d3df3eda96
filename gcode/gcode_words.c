// The words of a line: what each sets and what they mean together. Context: main loop.
#include "gcode/gcode_words.h"

#include <math.h>
#include <string.h>

// units/min; slower than any machine, and faster than the axes will allow.
#define FEED_MIN 0.001
#define FEED_MAX 1.0e9
#define BLEND_MAX_MM 1000.0

// ---- Codes --------------------------------------------------------------------------------------

static err_t set_action(line_t *line, action_t action) {
    if (line->action != ACTION_NONE) {
        return err_raise(ERR_GCODE_ONE_ACTION, NULL);
    }
    line->action = action;
    return ERR_OK;
}

// Takes note that a modal group has its word.
static err_t claim(line_t *line, group_t group) {
    static const char *const names[GROUPS] = {
        [GROUP_MOTION] = "motion modes", [GROUP_DISTANCE] = "distance modes",
        [GROUP_PLANE] = "planes",        [GROUP_PATH] = "path modes",
        [GROUP_CENTRE] = "centre modes",
    };
    if ((line->groups >> group) & 1) {
        return err_raise(ERR_GCODE_CONFLICT, "%s", names[group]);
    }
    line->groups |= 1u << group;
    return ERR_OK;
}

static err_t set_motion(line_t *line, motion_t motion) {
    line->modal.motion = motion;
    return claim(line, GROUP_MOTION);
}

static err_t set_distance(line_t *line, bool relative) {
    line->modal.relative = relative;
    return claim(line, GROUP_DISTANCE);
}

static err_t set_plane(line_t *line, gcode_plane_t plane) {
    line->modal.plane = plane;
    return claim(line, GROUP_PLANE);
}

static err_t set_corner(line_t *line, stepper_corner_t corner) {
    line->modal.path = (gcode_path_t){.corner = corner};
    return claim(line, GROUP_PATH);
}

static err_t unsupported(const gcode_word_t *word) {
    return err_raise(ERR_GCODE_UNSUPPORTED, "%c%g", word->letter, word->value);
}

// Ten times the number of a G or M word, so that G61.1 has one as well; -1 if there is no such
// code.
static int code_tenths(const gcode_word_t *word) {
    double tenths = floor(word->value * 10.0 + 0.5);
    bool fits = word->value >= 0.0 && word->value < 1000.0;
    return fits && fabs(word->value * 10.0 - tenths) < 1e-6 ? (int)tenths : -1;
}

static err_t read_g(line_t *line, const gcode_word_t *word) {
    switch (code_tenths(word)) {
    case 0:
        return set_motion(line, MOTION_RAPID);
    case 10:
        return set_motion(line, MOTION_FEED);
    case 20:
        return set_motion(line, MOTION_ARC_CW);
    case 30:
        return set_motion(line, MOTION_ARC_CCW);
    case 40:
        return set_action(line, ACTION_DWELL);
    case 170:
        return set_plane(line, GCODE_PLANE_XY);
    case 180:
        return set_plane(line, GCODE_PLANE_ZX);
    case 190:
        return set_plane(line, GCODE_PLANE_YZ);
    case 280:
        return set_action(line, ACTION_HOME);
    case 610:
        return set_corner(line, STEPPER_CORNER_EXACT);
    case 611:
        return set_corner(line, STEPPER_CORNER_STOP);
    case 640:
        return set_corner(line, STEPPER_CORNER_CONTINUOUS);
    case 900:
        return set_distance(line, false);
    case 910:
        return set_distance(line, true);
    case 911: // arc centres from the start, as they always are
        return claim(line, GROUP_CENTRE);
    case 920:
        return set_action(line, ACTION_OFFSET);
    default:
        return unsupported(word);
    }
}

static err_t read_m(line_t *line, const gcode_word_t *word) {
    switch (code_tenths(word)) {
    case 30:
        line->spindle_on = true;
        return set_action(line, ACTION_SPINDLE);
    case 50:
        line->spindle_on = false;
        return set_action(line, ACTION_SPINDLE);
    default:
        return unsupported(word);
    }
}

// ---- Words with a value -------------------------------------------------------------------------

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

static err_t read_centre(line_t *line, axis_id_t axis, double value) {
    if ((line->centres >> axis) & 1) {
        return twice(GCODE_CENTRE_LETTERS[axis]);
    }
    line->centres |= 1u << axis;
    line->centre[axis] = value;
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

static err_t read_once(char letter, bool *has, double *place, double value) {
    if (*has) {
        return twice(letter);
    }
    *has = true;
    *place = value;
    return ERR_OK;
}

static err_t read_word(line_t *line, const gcode_word_t *word) {
    static const char axes[] = STEPPER_AXIS_LETTERS;
    static const char centres[] = GCODE_CENTRE_LETTERS;
    const char *axis = memchr(axes, word->letter, AXIS_COUNT);
    if (axis != NULL) {
        return read_axis(line, (axis_id_t)(axis - axes), word->value);
    }
    axis = memchr(centres, word->letter, AXIS_A);
    if (axis != NULL) {
        return read_centre(line, (axis_id_t)(axis - centres), word->value);
    }
    switch (word->letter) {
    case 'G':
        return read_g(line, word);
    case 'M':
        return read_m(line, word);
    case 'F':
        return read_feed(line, word->value);
    case 'P':
        return read_once('P', &line->has_p, &line->p, word->value);
    case 'R':
        return read_once('R', &line->has_r, &line->r, word->value);
    default:
        return err_raise(ERR_GCODE_UNKNOWN_WORD, "%c", word->letter);
    }
}

// ---- What the words mean together ---------------------------------------------------------------

static err_t p_range(double value, const char *valid, double most) {
    return err_raise(ERR_GCODE_RANGE, "P: %g is invalid (valid is %s%.0f)", value, valid, most);
}

// P is the time of G4, the tolerance of G64 or the turns of an arc.
static err_t check_p(line_t *line) {
    bool dwell = line->action == ACTION_DWELL;
    bool blend = ((line->groups >> GROUP_PATH) & 1) != 0 &&
                 line->modal.path.corner == STEPPER_CORNER_CONTINUOUS;
    bool turns = line->action == ACTION_MOVE && line_is_arc(line);
    if (!line->has_p) {
        return dwell ? err_raise(ERR_GCODE_DWELL_P, NULL) : ERR_OK;
    }
    if (dwell + blend + turns != 1) {
        return err_raise(ERR_GCODE_P_ALONE, NULL);
    }
    double p = line->p;
    if (dwell && !(p >= 0.0 && p <= STEPPER_DWELL_MAX_MS)) {
        return p_range(p, "0 to ", STEPPER_DWELL_MAX_MS);
    }
    if (blend && !(p >= 0.0 && p <= BLEND_MAX_MM)) {
        return p_range(p, "0 to ", BLEND_MAX_MM);
    }
    if (turns && !(p >= 1.0 && p <= STEPPER_ARC_TURNS_MAX && p == floor(p))) {
        return p_range(p, "whole turns, 1 to ", STEPPER_ARC_TURNS_MAX);
    }
    if (blend && p > 0.0) {
        line->modal.path = (gcode_path_t){.corner = STEPPER_CORNER_BLEND, .blend_mm = p};
    }
    return ERR_OK;
}

static err_t check_action(line_t *line) {
    bool curved = line->centres != 0 || line->has_r;
    bool way = line->axes != 0 || curved;
    switch (line->action) {
    case ACTION_NONE:
        line->action = way ? ACTION_MOVE : ACTION_NONE;
        return curved && !line_is_arc(line) ? err_raise(ERR_GCODE_ARC_WORDS, NULL) : ERR_OK;
    case ACTION_DWELL:
    case ACTION_SPINDLE:
        return way ? err_raise(ERR_GCODE_ONE_ACTION, NULL) : ERR_OK;
    case ACTION_OFFSET:
        if (line->axes == 0) {
            return err_raise(ERR_GCODE_OFFSET_AXIS, NULL);
        }
        return curved || ((line->groups >> GROUP_MOTION) & 1)
                   ? err_raise(ERR_GCODE_ONE_ACTION, NULL)
                   : ERR_OK;
    case ACTION_HOME:
        return err_raise(ERR_GCODE_NO_HOMING, NULL);
    case ACTION_MOVE:
        break;
    }
    return ERR_OK;
}

err_t gcode_words_read(line_t *line, const modal_t *before, const gcode_word_t *words,
                       size_t count) {
    *line = (line_t){.modal = *before};
    err_t err = ERR_OK;
    for (size_t i = 0; i < count && err == ERR_OK; i++) {
        err = read_word(line, &words[i]);
    }
    if (err == ERR_OK) {
        err = check_action(line);
    }
    return err == ERR_OK ? check_p(line) : err;
}
