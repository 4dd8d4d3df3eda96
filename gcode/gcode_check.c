// What the words of a line mean together: RS274/NGC's rules on which code uses which word. Context:
// main loop.
#include "gcode/gcode_check.h"

#include <math.h>

// ---- Which code uses what -----------------------------------------------------------------------

// The dialect says what G28 is, P what G30 goes to.
static err_t resolve_once(line_t *line, const gcode_state_t *before) {
    if (line->once == ONCE_G28) {
        line->once = before->options.nist ? ONCE_GO_STORED : ONCE_HOME;
        line->stored = STORED_G28;
        return line_has(line, WORD_P) ? err_raise(ERR_GCODE_UNUSED, "P") : ERR_OK;
    }
    if (line->once == ONCE_G30) {
        line->once = ONCE_GO_STORED;
        double p = line_has(line, WORD_P) ? line->value[WORD_P] : 2.0;
        if (p != 1.0 && p != 2.0) {
            return err_raise(ERR_GCODE_RANGE, "P: %.10g is invalid (valid is 1 or 2 with G30)", p);
        }
        line->stored = p == 1.0 ? STORED_G28 : STORED_G30;
    }
    return ERR_OK;
}

// The code besides a motion mode that uses the axis words; NULL: none.
static const char *other_user_of_axes(const line_t *line) {
    switch ((once_t)line->once) {
    case ONCE_SET:
        return "G10";
    case ONCE_HOME:
        return "homing";
    case ONCE_GO_STORED:
        return line->stored == STORED_G28 ? "G28" : "G30";
    case ONCE_SHIFT:
        return "G92";
    default:
        return NULL;
    }
}

static bool gives_length(const line_t *line) {
    return line_has_group(line, GROUP_TOOL_LENGTH) && line->length == LENGTH_GIVEN;
}

static err_t find_user_of_axes(line_t *line) {
    const char *user = other_user_of_axes(line);
    bool given = gives_length(line);
    bool motion = line_has_group(line, GROUP_MOTION) && line->modal.motion != MOTION_NONE;
    if ((user != NULL || given) && motion) {
        return err_raise(ERR_GCODE_AXES_TWICE, "%s and a motion mode",
                         user != NULL ? user : "G43.1");
    }
    if (user != NULL && given) {
        return err_raise(ERR_GCODE_AXES_TWICE, "%s and G43.1", user);
    }
    if (user != NULL || given) {
        return ERR_OK;
    }
    uint32_t way = WORDS_AXES;
    if (line_is_arc(line)) {
        way |= WORDS_CENTRE | WORD_BIT(WORD_R);
    }
    line->moves = (line->words & way) != 0;
    if (line->moves && line->modal.motion == MOTION_NONE && !line_has_group(line, GROUP_MOTION)) {
        return err_raise(ERR_GCODE_NO_MOTION, NULL);
    }
    return ERR_OK;
}

static uint32_t used_by_motion(const line_t *line) {
    static const uint16_t of_cycles[] = {
        [MOTION_CYCLE_CHIPS - MOTION_CYCLE_CHIPS] = WORD_BIT(WORD_Q),
        [MOTION_CYCLE_DRILL - MOTION_CYCLE_CHIPS] = 0,
        [MOTION_CYCLE_DWELL - MOTION_CYCLE_CHIPS] = WORD_BIT(WORD_P),
        [MOTION_CYCLE_PECK - MOTION_CYCLE_CHIPS] = WORD_BIT(WORD_Q),
    };
    if (!line->moves || line->modal.motion == MOTION_NONE) {
        return 0;
    }
    if (line_is_arc(line)) {
        return WORDS_AXES | WORDS_CENTRE | WORD_BIT(WORD_R) | WORD_BIT(WORD_P);
    }
    if (line_is_cycle(line)) {
        return WORDS_AXES | WORD_BIT(WORD_R) | WORD_BIT(WORD_L) |
               of_cycles[line->modal.motion - MOTION_CYCLE_CHIPS];
    }
    return WORDS_AXES;
}

static uint32_t used_by_once(const line_t *line) {
    switch ((once_t)line->once) {
    case ONCE_DWELL:
        return WORD_BIT(WORD_P);
    case ONCE_SET:
        return WORDS_AXES | WORD_BIT(WORD_P) | WORD_BIT(WORD_L);
    case ONCE_HOME:
    case ONCE_SHIFT:
        return WORDS_AXES;
    case ONCE_GO_STORED:
        return WORDS_AXES | WORD_BIT(WORD_P);
    default:
        return 0;
    }
}

static bool blends(const line_t *line) {
    return line_has_group(line, GROUP_PATH) && line->modal.path.corner == STEPPER_CORNER_CONTINUOUS;
}

static uint32_t used_by_modes(const line_t *line) {
    uint32_t used = blends(line) ? WORD_BIT(WORD_P) | WORD_BIT(WORD_Q) : 0;
    if (line_has_group(line, GROUP_TOOL_LENGTH)) {
        used |= line->length == LENGTH_OF_TOOL ? WORD_BIT(WORD_H) : 0;
        used |= line->length == LENGTH_GIVEN ? WORD_BIT(WORD_Z) : 0;
    }
    return used;
}

static err_t check_uses(const line_t *line) {
    uint32_t motion = used_by_motion(line);
    uint32_t once = used_by_once(line);
    uint32_t modes = used_by_modes(line);
    uint32_t p = WORD_BIT(WORD_P);
    uint32_t always = WORD_BIT(WORD_F) | WORD_BIT(WORD_N) | WORD_BIT(WORD_S) | WORD_BIT(WORD_T);
    uint32_t unused = line->words & ~(always | motion | once | modes);
    for (unsigned word = 0; unused != 0; word++, unused >>= 1) {
        if (unused & 1) {
            return err_raise(ERR_GCODE_UNUSED, "%c", GCODE_WORD_LETTERS[word]);
        }
    }
    bool twice = ((motion & once) | (motion & modes) | (once & modes)) & p;
    return twice && line_has(line, WORD_P) ? err_raise(ERR_GCODE_TWO_USES, NULL) : ERR_OK;
}

// ---- Units --------------------------------------------------------------------------------------

static void convert_inches(line_t *line) {
    static const uint8_t lengths[] = {WORD_X, WORD_Y, WORD_Z, WORD_I,
                                      WORD_J, WORD_K, WORD_Q, WORD_R};
    for (unsigned i = 0; i < COUNT_OF_ARRAY(lengths); i++) {
        if (line_has(line, (word_t)lengths[i])) {
            line->value[lengths[i]] *= GCODE_MM_PER_INCH;
        }
    }
    if (blends(line) && line_has(line, WORD_P)) {
        line->value[WORD_P] *= GCODE_MM_PER_INCH;
    }
    if (!line->modal.inverse_time && line_has(line, WORD_F)) {
        line->value[WORD_F] *= GCODE_MM_PER_INCH;
    }
}

// ---- Values -------------------------------------------------------------------------------------

static err_t p_range(double value, const char *valid, double most) {
    return err_raise(ERR_GCODE_RANGE, "P: %.10g is invalid (valid is %s%.0f)", value, valid, most);
}

static bool is_whole(double value, double min, double max) {
    return value >= min && value <= max && value == floor(value);
}

static err_t needs(const char *what) {
    return err_raise(ERR_GCODE_NEEDS, "%s", what);
}

static err_t check_dwell(line_t *line, const gcode_state_t *before) {
    if (!line_has(line, WORD_P)) {
        return err_raise(ERR_GCODE_DWELL_P, NULL);
    }
    double unit_ms = before->options.nist ? 1000.0 : 1.0;
    double p = line->value[WORD_P];
    if (!(p >= 0.0 && p * unit_ms <= STEPPER_DWELL_MAX_MS)) {
        return p_range(p, "0 to ", STEPPER_DWELL_MAX_MS / unit_ms);
    }
    line->value[WORD_P] = p * unit_ms;
    return ERR_OK;
}

static err_t check_set(const line_t *line) {
    if (!line_has(line, WORD_L)) {
        return needs("G10 needs L1, L2 or L20");
    }
    double l = line->value[WORD_L];
    if (l != 1.0 && l != 2.0 && l != 20.0) {
        return err_raise(ERR_GCODE_RANGE, "L: %.10g is invalid (valid is 1, 2 and 20 with G10)", l);
    }
    if (!line_has(line, WORD_P)) {
        return needs(l == 1.0 ? "G10 L1 needs P, the tool"
                              : "G10 needs P, the coordinate system (0: the one in force)");
    }
    double first = l == 1.0 ? 1.0 : 0.0;
    double last = l == 1.0 ? GCODE_TOOLS : GCODE_SYSTEMS;
    if (!is_whole(line->value[WORD_P], first, last)) {
        return p_range(line->value[WORD_P], l == 1.0 ? "1 to " : "0 to ", last);
    }
    uint32_t axes = line->words & WORDS_AXES;
    if (l == 1.0 && axes != WORD_BIT(WORD_Z)) {
        return needs("G10 L1 needs Z, the length of the tool, and no other axis");
    }
    return axes == 0 ? needs("G10 needs an axis value") : ERR_OK;
}

static err_t check_once(line_t *line, const gcode_state_t *before) {
    uint32_t axes = line->words & WORDS_AXES;
    switch ((once_t)line->once) {
    case ONCE_DWELL:
        return check_dwell(line, before);
    case ONCE_SET:
        return check_set(line);
    case ONCE_HOME:
        return axes == WORD_BIT(WORD_A) ? err_raise(ERR_GCODE_HOME_AXES, NULL) : ERR_OK;
    case ONCE_GO_STORED:
        return before->has_stored[line->stored]
                   ? ERR_OK
                   : err_raise(ERR_GCODE_NOT_STORED, "%s",
                               line->stored == STORED_G28 ? "G28.1" : "G30.1");
    case ONCE_SHIFT:
        line->modal.shifted = true;
        return axes == 0 ? err_raise(ERR_GCODE_OFFSET_AXIS, NULL) : ERR_OK;
    case ONCE_SHIFT_CLEAR:
    case ONCE_SHIFT_SUSPEND:
        line->modal.shifted = false;
        return ERR_OK;
    case ONCE_SHIFT_RESTORE:
        line->modal.shifted = true;
        return ERR_OK;
    case ONCE_MACHINE:
        return line->modal.motion == MOTION_RAPID || line->modal.motion == MOTION_FEED
                   ? ERR_OK
                   : err_raise(ERR_GCODE_MACHINE_MOTION, NULL);
    default:
        return ERR_OK;
    }
}

static err_t check_blend(line_t *line) {
    if (!blends(line) || !line_has(line, WORD_P)) {
        return ERR_OK;
    }
    double p = line->value[WORD_P];
    if (!(p >= 0.0 && p <= GCODE_BLEND_MAX_MM)) {
        return p_range(p, "0 to ", GCODE_BLEND_MAX_MM);
    }
    if (p > 0.0) {
        line->modal.path = (gcode_path_t){.corner = STEPPER_CORNER_BLEND, .blend_mm = p};
    }
    return ERR_OK;
}

static err_t check_cycle(line_t *line, const gcode_state_t *before) {
    if (line->modal.plane != PLANE_XY) {
        return needs("Canned cycles need G17, the XY plane");
    }
    return line_has(line, WORD_P) ? check_dwell(line, before) : ERR_OK;
}

static err_t check_motion(line_t *line, const gcode_state_t *before) {
    const modal_t *modal = &line->modal;
    if (!line->moves) {
        bool asked =
            line_has_group(line, GROUP_MOTION) && (line_is_probe(line) || line_is_cycle(line));
        return asked ? needs("G38 and canned cycles need an axis value") : ERR_OK;
    }
    if (line_is_arc(line) && line_has(line, WORD_P) &&
        !is_whole(line->value[WORD_P], 1.0, STEPPER_ARC_TURNS_MAX)) {
        return p_range(line->value[WORD_P], "whole turns, 1 to ", STEPPER_ARC_TURNS_MAX);
    }
    err_t err = line_is_cycle(line) ? check_cycle(line, before) : ERR_OK;
    if (err != ERR_OK) {
        return err;
    }
    if (modal->motion == MOTION_RAPID || modal->motion == MOTION_NONE) {
        return ERR_OK;
    }
    if (!modal->inverse_time) {
        return modal->feed > 0.0 ? ERR_OK : err_raise(ERR_GCODE_NO_FEED, NULL);
    }
    if (line_is_probe(line) || line_is_cycle(line)) {
        return err_raise(ERR_GCODE_INVERSE_MODE, "%s", line_is_probe(line) ? "probing" : "cycles");
    }
    return line_has(line, WORD_F) ? ERR_OK : err_raise(ERR_GCODE_INVERSE_FEED, NULL);
}

// ---- The modal state behind the line ------------------------------------------------------------

// A feed of one mode means nothing in the other.
static void set_feed(line_t *line, const gcode_state_t *before) {
    modal_t *modal = &line->modal;
    if (modal->inverse_time != before->modal.inverse_time) {
        modal->feed = 0.0;
    }
    if (line_has(line, WORD_F) && !modal->inverse_time) {
        modal->feed = line->value[WORD_F];
        modal->feed_in_inches = modal->inches;
    }
}

static double length_of_tool(const gcode_state_t *before, double number) {
    return number >= 1.0 && number <= GCODE_TOOLS ? before->tool_lengths_mm[(unsigned)number - 1]
                                                  : 0.0;
}

static void set_tool(line_t *line, const gcode_state_t *before) {
    modal_t *modal = &line->modal;
    if (line_has(line, WORD_T)) {
        modal->next_tool = (uint32_t)line->value[WORD_T];
    }
    if (line_has_group(line, GROUP_TOOL_CHANGE)) {
        modal->tool = modal->next_tool;
        if (!line_has_group(line, GROUP_SPINDLE)) {
            modal->spindle = STEPPER_SPINDLE_OFF;
        }
    }
    if (!line_has_group(line, GROUP_TOOL_LENGTH)) {
        return;
    }
    double number = line_has(line, WORD_H) ? line->value[WORD_H] : (double)modal->tool;
    modal->tool_length_mm = line->length == LENGTH_OF_TOOL ? length_of_tool(before, number)
                            : line->length == LENGTH_GIVEN ? line->value[WORD_Z]
                                                           : 0.0;
}

err_t gcode_check(line_t *line, const gcode_state_t *before) {
    err_t err = resolve_once(line, before);
    if (err == ERR_OK) {
        err = find_user_of_axes(line);
    }
    if (err == ERR_OK) {
        err = check_uses(line);
    }
    if (err != ERR_OK) {
        return err;
    }
    if (gives_length(line) && !line_has(line, WORD_Z)) {
        return needs("G43.1 needs Z, the length of the tool");
    }
    if (line->modal.inches) {
        convert_inches(line);
    }
    set_feed(line, before);
    set_tool(line, before);
    if (line_has(line, WORD_S)) {
        line->modal.rpm = line->value[WORD_S];
    }
    err = check_once(line, before);
    if (err == ERR_OK) {
        err = check_blend(line);
    }
    return err == ERR_OK ? check_motion(line, before) : err;
}
