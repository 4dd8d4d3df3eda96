// The table of G and M codes: the modal group of each and what it chooses there. Context: main
// loop.
#include "gcode/gcode_codes.h"

#include <math.h>

typedef struct {
    uint16_t tenths; // ten times the number, so that G61.1 has one as well
    uint8_t group;
    uint8_t value; // by group
} code_t;

// Values of GROUP_SPINDLE are stepper_turn_t; these are those of GROUP_COOLANT.
enum { COOLANT_OFF, COOLANT_FLOOD, COOLANT_MIST };

// The frequent ones first: the search is linear.
static const code_t g_codes[] = {
    {10, GROUP_MOTION, MOTION_FEED},
    {0, GROUP_MOTION, MOTION_RAPID},
    {20, GROUP_MOTION, MOTION_ARC_CW},
    {30, GROUP_MOTION, MOTION_ARC_CCW},
    {900, GROUP_DISTANCE, false},
    {910, GROUP_DISTANCE, true},
    {40, GROUP_ONCE, ONCE_DWELL},
    {100, GROUP_ONCE, ONCE_SET},
    {170, GROUP_PLANE, PLANE_XY},
    {180, GROUP_PLANE, PLANE_ZX},
    {190, GROUP_PLANE, PLANE_YZ},
    {200, GROUP_UNITS, true},
    {210, GROUP_UNITS, false},
    {280, GROUP_ONCE, ONCE_G28},
    {281, GROUP_ONCE, ONCE_STORE_G28},
    {282, GROUP_ONCE, ONCE_HOME},
    {300, GROUP_ONCE, ONCE_G30},
    {301, GROUP_ONCE, ONCE_STORE_G30},
    {382, GROUP_MOTION, MOTION_PROBE_TO},
    {383, GROUP_MOTION, MOTION_PROBE_TO_MAYBE},
    {384, GROUP_MOTION, MOTION_PROBE_OFF},
    {385, GROUP_MOTION, MOTION_PROBE_OFF_MAYBE},
    {400, GROUP_COMPENSATION, false},
    {410, GROUP_COMPENSATION, true},
    {420, GROUP_COMPENSATION, true},
    {430, GROUP_TOOL_LENGTH, LENGTH_OF_TOOL},
    {431, GROUP_TOOL_LENGTH, LENGTH_GIVEN},
    {490, GROUP_TOOL_LENGTH, LENGTH_NONE},
    {530, GROUP_ONCE, ONCE_MACHINE},
    {540, GROUP_SYSTEM, 0},
    {550, GROUP_SYSTEM, 1},
    {560, GROUP_SYSTEM, 2},
    {570, GROUP_SYSTEM, 3},
    {580, GROUP_SYSTEM, 4},
    {590, GROUP_SYSTEM, 5},
    {591, GROUP_SYSTEM, 6},
    {592, GROUP_SYSTEM, 7},
    {593, GROUP_SYSTEM, 8},
    {610, GROUP_PATH, STEPPER_CORNER_EXACT},
    {611, GROUP_PATH, STEPPER_CORNER_STOP},
    {640, GROUP_PATH, STEPPER_CORNER_CONTINUOUS},
    {730, GROUP_MOTION, MOTION_CYCLE_CHIPS},
    {800, GROUP_CYCLE_END, MOTION_NONE},
    {810, GROUP_MOTION, MOTION_CYCLE_DRILL},
    {820, GROUP_MOTION, MOTION_CYCLE_DWELL},
    {830, GROUP_MOTION, MOTION_CYCLE_PECK},
    {901, GROUP_CENTRE, true},
    {911, GROUP_CENTRE, false},
    {920, GROUP_ONCE, ONCE_SHIFT},
    {921, GROUP_ONCE, ONCE_SHIFT_CLEAR},
    {922, GROUP_ONCE, ONCE_SHIFT_SUSPEND},
    {923, GROUP_ONCE, ONCE_SHIFT_RESTORE},
    {930, GROUP_FEED_MODE, true},
    {940, GROUP_FEED_MODE, false},
    {980, GROUP_RETRACT, false},
    {990, GROUP_RETRACT, true},
};

static const code_t m_codes[] = {
    {0, GROUP_STOP, STOP_PAUSE},
    {10, GROUP_STOP, STOP_OPTIONAL},
    {20, GROUP_STOP, STOP_END},
    {30, GROUP_SPINDLE, STEPPER_SPINDLE_CW},
    {40, GROUP_SPINDLE, STEPPER_SPINDLE_CCW},
    {50, GROUP_SPINDLE, STEPPER_SPINDLE_OFF},
    {60, GROUP_TOOL_CHANGE, 0},
    {70, GROUP_COOLANT, COOLANT_MIST},
    {80, GROUP_COOLANT, COOLANT_FLOOD},
    {90, GROUP_COOLANT, COOLANT_OFF},
    {300, GROUP_STOP, STOP_END},
    {480, GROUP_OVERRIDES, 0}, // overrides are always allowed
};

static const char *const group_names[GROUPS] = {
    [GROUP_MOTION] = "motion modes",
    [GROUP_CYCLE_END] = "G80",
    [GROUP_ONCE] = "codes out of G4, G10, G28, G30, G53 and G92",
    [GROUP_PLANE] = "planes",
    [GROUP_DISTANCE] = "distance modes",
    [GROUP_CENTRE] = "centre modes",
    [GROUP_FEED_MODE] = "feed modes",
    [GROUP_UNITS] = "units",
    [GROUP_COMPENSATION] = "tool radius modes",
    [GROUP_TOOL_LENGTH] = "tool length modes",
    [GROUP_RETRACT] = "return modes",
    [GROUP_SYSTEM] = "coordinate systems",
    [GROUP_PATH] = "path modes",
    [GROUP_STOP] = "codes out of M0, M1, M2 and M30",
    [GROUP_TOOL_CHANGE] = "M6",
    [GROUP_SPINDLE] = "codes out of M3, M4 and M5",
    [GROUP_COOLANT] = "codes out of M7, M8 and M9",
    [GROUP_OVERRIDES] = "M48",
};

// Ten times the number; -1 if no code has it.
static int tenths_of(double value) {
    if (!(value >= 0.0 && value < 1000.0)) {
        return -1;
    }
    int whole = (int)value;
    if ((double)whole == value) {
        return whole * 10;
    }
    double tenths = floor(value * 10.0 + 0.5);
    return fabs(value * 10.0 - tenths) < 1e-6 ? (int)tenths : -1;
}

static const code_t *find(const code_t *codes, size_t count, int tenths) {
    for (size_t i = 0; i < count; i++) {
        if (codes[i].tenths == tenths) {
            return &codes[i];
        }
    }
    return NULL;
}

static err_t set_coolant(modal_t *modal, unsigned value) {
    modal->flood = value == COOLANT_FLOOD || (value == COOLANT_MIST && modal->flood);
    modal->mist = value == COOLANT_MIST || (value == COOLANT_FLOOD && modal->mist);
    return ERR_OK;
}

static err_t apply(line_t *line, const code_t *code) {
    modal_t *modal = &line->modal;
    uint8_t value = code->value;
    switch ((group_t)code->group) {
    case GROUP_MOTION:
        modal->motion = value;
        break;
    case GROUP_CYCLE_END: // beside another motion mode it says nothing more
        if (!line_has_group(line, GROUP_MOTION)) {
            modal->motion = value;
        }
        break;
    case GROUP_ONCE:
        line->once = value;
        break;
    case GROUP_PLANE:
        modal->plane = value;
        break;
    case GROUP_DISTANCE:
        modal->relative = value != 0;
        break;
    case GROUP_CENTRE:
        modal->centre_absolute = value != 0;
        break;
    case GROUP_FEED_MODE:
        modal->inverse_time = value != 0;
        break;
    case GROUP_UNITS:
        modal->inches = value != 0;
        break;
    case GROUP_COMPENSATION:
        return value != 0 ? err_raise(ERR_GCODE_COMPENSATION, NULL) : ERR_OK;
    case GROUP_TOOL_LENGTH:
        line->length = value;
        break;
    case GROUP_RETRACT:
        modal->retract_to_r = value != 0;
        break;
    case GROUP_SYSTEM:
        modal->system = value;
        break;
    case GROUP_PATH:
        modal->path = (gcode_path_t){.corner = (stepper_corner_t)value};
        break;
    case GROUP_STOP:
        line->stop = value;
        break;
    case GROUP_SPINDLE:
        modal->spindle = value;
        break;
    case GROUP_COOLANT:
        return set_coolant(modal, value);
    case GROUP_TOOL_CHANGE:
    case GROUP_OVERRIDES:
    case GROUPS:
        break;
    }
    return ERR_OK;
}

err_t gcode_codes_read(line_t *line, char letter, double value) {
    int tenths = tenths_of(value);
    const code_t *code = letter == 'G' ? find(g_codes, COUNT_OF_ARRAY(g_codes), tenths)
                                       : find(m_codes, COUNT_OF_ARRAY(m_codes), tenths);
    if (code == NULL) {
        return err_raise(ERR_GCODE_UNSUPPORTED, "%c%.12g", letter, value);
    }
    if (line_has_group(line, (group_t)code->group)) {
        return err_raise(ERR_GCODE_CONFLICT, "%s", group_names[code->group]);
    }
    line->groups |= 1u << code->group;
    return apply(line, code);
}
