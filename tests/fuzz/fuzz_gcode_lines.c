// Generates G-code lines in all the ways they may be written.
#include "fuzz_gcode_lines.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz_random.h"

#define PARTS_MAX 12
#define REACH_MILLI 60000 // farthest right target, in thousandths of a unit

static const char letters[AXIS_COUNT] = {'X', 'Y', 'Z', 'A'};

typedef struct {
    char parts[PARTS_MAX][32]; // words
    unsigned count;
} words_t;

// A number of thousandths in one of the forms people use.
static void add_word(words_t *words, char letter, int milli) {
    char *part = words->parts[words->count++];
    const char *sign = milli < 0 ? "-" : fuzz_random_percent(10) ? "+" : "";
    int whole = abs(milli) / 1000;
    int rest = abs(milli) % 1000;
    if (rest == 0 && fuzz_random_percent(70)) {
        snprintf(part, sizeof words->parts[0], "%c%s%d%s", letter, sign, whole,
                 fuzz_random_percent(20) ? "." : "");
    } else if (whole == 0 && fuzz_random_percent(30)) {
        snprintf(part, sizeof words->parts[0], "%c%s.%03d", letter, sign, rest);
    } else {
        snprintf(part, sizeof words->parts[0], "%c%s%0*d.%03d", letter, sign,
                 fuzz_random_percent(5) ? 6 : 1, whole, rest);
    }
}

static void shuffle(words_t *words) {
    for (unsigned i = words->count; i > 1; i--) {
        char swap[32];
        unsigned j = fuzz_random_below(i);
        memcpy(swap, words->parts[i - 1], sizeof swap);
        memcpy(words->parts[i - 1], words->parts[j], sizeof swap);
        memcpy(words->parts[j], swap, sizeof swap);
    }
}

static void add_gap(fuzz_text_t *text) {
    static const char *const gaps[] = {"",   "",  " ",   " ",     " ",          "  ",
                                       "\t", ",", " , ", "(gap)", " ( X1 Y2 ) "};
    fuzz_text_add(text, "%s", FUZZ_RANDOM_PICK(gaps));
}

static void write_words(fuzz_text_t *text, words_t *words) {
    shuffle(words);
    bool lower = fuzz_random_percent(20);
    for (unsigned i = 0; i < words->count; i++) {
        add_gap(text);
        for (const char *p = words->parts[i]; *p != '\0'; p++) {
            fuzz_text_byte(text, lower ? (char)tolower((unsigned char)*p) : *p);
            if (p == words->parts[i] && fuzz_random_percent(5)) {
                add_gap(text);
            }
        }
    }
    add_gap(text);
    if (fuzz_random_percent(15)) {
        fuzz_text_add(text, "%s", fuzz_random_percent(50) ? "; G1 X9999" : "' comment");
    }
}

// Axis words that lead to a place within reach, or none if there is no axis.
static void add_axes(words_t *words, fuzz_gcode_line_t *line, bool relative, bool fine,
                     const double work_position[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (!stepper_axis_configured(axis) || fuzz_random_percent(50)) {
            continue;
        }
        double unit = line->inches && axis != AXIS_A ? 25.4 : 1.0;
        int reach = (int)((fuzz_random_percent(90) ? 2000 : REACH_MILLI) / unit);
        int milli = fuzz_random_between(-reach, reach);
        if (fine && relative) {
            milli = fuzz_random_between(-5, 15);
        }
        if (relative && fabs(work_position[axis] + milli / 1000.0 * unit) > REACH_MILLI / 1000.0) {
            milli = work_position[axis] > 0 ? -abs(milli) : abs(milli);
        }
        add_word(words, letters[axis], milli);
        line->axes |= 1u << axis;
        line->value[axis] = milli / 1000.0 * unit;
    }
}

static void add_modes(words_t *words, fuzz_gcode_line_t *line, const fuzz_gcode_modal_t *modal) {
    line->sets_distance = fuzz_random_percent(15);
    line->relative = line->sets_distance ? fuzz_random_percent(50) : modal->relative;
    if (line->sets_distance) {
        add_word(words, 'G', line->relative ? 91000 : 90000);
    }
    line->sets_units = fuzz_random_percent(10);
    line->inches = line->sets_units ? fuzz_random_percent(40) : modal->inches;
    if (line->sets_units) {
        add_word(words, 'G', line->inches ? 20000 : 21000);
    }
    line->sets_system = fuzz_random_percent(8);
    line->system = line->sets_system ? fuzz_random_below(FUZZ_GCODE_SYSTEMS) : modal->system;
    if (line->sets_system) {
        static const int codes[] = {54000, 55000, 56000, 57000, 58000, 59000, 59100, 59200, 59300};
        add_word(words, 'G', codes[line->system]);
    }
    if (fuzz_random_percent(10)) {
        add_word(words, 'N', fuzz_random_between(0, 99999) * 1000);
    }
    if (fuzz_random_percent(30)) {
        int milli = fuzz_random_between(100, 8000) * 1000;
        add_word(words, 'F', milli);
        line->feed = milli / 1000.0;
    }
}

static void add_move(words_t *words, fuzz_gcode_line_t *line, const fuzz_gcode_modal_t *modal,
                     const double work_position[AXIS_COUNT]) {
    bool can_feed = modal->has_feed || line->feed > 0;
    line->sets_motion =
        !modal->has_motion || (!modal->rapid && !can_feed) || fuzz_random_percent(30);
    line->rapid = line->sets_motion ? !can_feed || fuzz_random_percent(20) : modal->rapid;
    if (line->sets_motion) {
        add_word(words, 'G', line->rapid ? 0 : 1000);
    }
    bool can_be_machine = line->sets_motion || modal->has_motion;
    line->machine = can_be_machine && fuzz_random_percent(5);
    if (line->machine) {
        add_word(words, 'G', 53000);
    }
    add_axes(words, line, line->relative && !line->machine, modal->fine, work_position);
    line->kind = line->axes != 0 ? FUZZ_GCODE_MOVE : FUZZ_GCODE_NOTHING;
}

// Some quarter turns about a centre in thousandths end in thousandths. Relative mode only: where
// the machine stands after a stop may have no such coordinates.
static void add_arc(words_t *words, fuzz_gcode_line_t *line) {
    bool clockwise = fuzz_random_percent(50);
    double unit = line->inches ? 25.4 : 1.0;
    int reach = (int)(3000 / unit);
    int centre[2] = {fuzz_random_between(10, reach), fuzz_random_between(-reach, -10)};
    int end[2] = {-centre[0], -centre[1]};
    int quarters = (int)fuzz_random_below(4); // 0: a full circle
    for (int i = 0; i < (clockwise ? 4 - quarters : quarters); i++) {
        int x = end[0];
        end[0] = -end[1];
        end[1] = x;
    }
    add_word(words, 'G', clockwise ? 2000 : 3000);
    add_word(words, 'I', centre[0]);
    add_word(words, 'J', centre[1]);
    for (axis_id_t axis = AXIS_X; axis <= AXIS_Y; axis++) {
        line->value[axis] = (centre[axis] + end[axis]) / 1000.0 * unit;
        line->axes |= 1u << axis;
        add_word(words, letters[axis], centre[axis] + end[axis]);
    }
    if (stepper_axis_configured(AXIS_Z) && fuzz_random_percent(20)) {
        int milli = fuzz_random_between(-500, 500) / (line->inches ? 25 : 1);
        add_word(words, 'Z', milli);
        line->axes |= 1u << AXIS_Z;
        line->value[AXIS_Z] = milli / 1000.0 * unit;
    }
    line->kind = FUZZ_GCODE_MOVE;
    line->arc = true;
}

// How corners are passed from now on; with a tolerance in P.
static void add_path_mode(words_t *words) {
    static const int codes[] = {61000, 61100, 64000, 64000};
    int code = FUZZ_RANDOM_PICK(codes);
    add_word(words, 'G', code);
    if (code == 64000 && fuzz_random_percent(60)) {
        add_word(words, 'P', fuzz_random_between(0, 300));
    }
}

// Where work zero is: G92, G92.1, G10 L2, tool length.
static void add_origin(words_t *words, fuzz_gcode_line_t *line, const double at[AXIS_COUNT]) {
    bool has_z = stepper_axis_configured(AXIS_Z);
    switch (fuzz_random_below(4)) {
    case 0:
        line->kind = FUZZ_GCODE_OFFSET_CLEAR;
        add_word(words, 'G', 92100);
        return;
    case 1:
        line->kind = FUZZ_GCODE_LENGTH;
        if (has_z && fuzz_random_percent(70)) {
            int milli = fuzz_random_between(-200, 200);
            add_word(words, 'G', 43100);
            add_word(words, 'Z', milli);
            line->length_mm = milli / 1000.0 * (line->inches ? 25.4 : 1.0);
        } else {
            add_word(words, 'G', 49000);
        }
        return;
    default:
        break;
    }
    add_axes(words, line, false, false, at);
    if (line->axes == 0) {
        return;
    }
    if (fuzz_random_percent(50)) {
        line->kind = FUZZ_GCODE_OFFSET;
        add_word(words, 'G', 92000);
    } else {
        line->kind = FUZZ_GCODE_SYSTEM;
        line->table = fuzz_random_below(FUZZ_GCODE_SYSTEMS + 1);
        add_word(words, 'G', 10000);
        add_word(words, 'L', 2000);
        add_word(words, 'P', (int)line->table * 1000);
    }
}

// Entries of their own ahead of what else the line does.
static void add_switches(words_t *words, const fuzz_gcode_modal_t *modal) {
    if (modal->spindle && fuzz_random_percent(20)) {
        add_word(words, 'M', fuzz_random_percent(50) ? 3000 : 5000);
    }
    if (fuzz_random_percent(10)) {
        add_word(words, 'S', fuzz_random_between(0, 24000) * 1000);
    }
    if (fuzz_random_percent(5)) {
        add_word(words, 'M', 9000);
    }
}

void fuzz_gcode_right_line(fuzz_text_t *text, fuzz_gcode_line_t *line,
                           const fuzz_gcode_modal_t *modal,
                           const double work_position[AXIS_COUNT]) {
    words_t words = {.count = 0};
    *line = (fuzz_gcode_line_t){.kind = FUZZ_GCODE_NOTHING};
    add_modes(&words, line, modal);
    switch (fuzz_random_below(20)) {
    case 0:
        break; // modes alone, or nothing
    case 1:
        line->kind = FUZZ_GCODE_DWELL;
        add_word(&words, 'G', 4000);
        add_word(&words, 'P', fuzz_random_between(0, 50000));
        add_switches(&words, modal);
        break;
    case 2:
        add_origin(&words, line, work_position);
        break;
    case 3:
        add_switches(&words, modal);
        line->kind = FUZZ_GCODE_SPINDLE;
        break;
    case 4:
        add_path_mode(&words);
        break;
    case 5:
    case 6:
        if (line->relative && (modal->has_feed || line->feed > 0) &&
            stepper_axis_configured(AXIS_X) && stepper_axis_configured(AXIS_Y) &&
            fabs(work_position[AXIS_X]) + fabs(work_position[AXIS_Y]) < REACH_MILLI / 1000.0) {
            add_arc(&words, line);
        }
        break;
    case 7:
        add_switches(&words, modal);
        // fall through
    default:
        add_move(&words, line, modal, work_position);
        break;
    }
    write_words(text, &words);
}

void fuzz_gcode_any_line(fuzz_text_t *text) {
    static const char *const codes[] = {
        "G0",    "G1",    "G1",  "G4",    "G90", "G91",   "G92",   "M3",         "M5",    "G28",
        "G2",    "G3",    "G21", "G20",   "M2",  "M30",   "G92.1", "G-1",        "G",     "N10",
        "T1",    "%",     "G17", "G18",   "G19", "G61",   "G61.1", "G64",        "G91.1", "G2",
        "G3",    "G10",   "L2",  "L20",   "L1",  "P1",    "G28.1", "G30",        "G30.1", "G38.2",
        "G38.3", "G38.5", "G40", "G41",   "G43", "G43.1", "H1",    "G49",        "G53",   "G54",
        "G59.3", "G73",   "G80", "G81",   "G82", "G83",   "R1",    "Q.5",        "G90.1", "G92.2",
        "G92.3", "G93",   "G94", "G98",   "G99", "M0",    "M1",    "M4",         "M6",    "M7",
        "M8",    "M9",    "M48", "S1000", "/",   "O100",  "F500",  "(MSG,hello)"};
    static const char words[] = "XYZAFPXYZAFPIJKRSNTELBCUVW$*HLQODXYZ";
    for (unsigned i = fuzz_random_below(8); i > 0; i--) {
        add_gap(text);
        if (fuzz_random_percent(35)) {
            fuzz_text_add(text, "%s", FUZZ_RANDOM_PICK(codes));
        } else {
            fuzz_text_byte(text, words[fuzz_random_below(sizeof words - 1)]);
            fuzz_text_number(text);
        }
    }
    add_gap(text);
}
