// Looks through a G-code file without moving anything: a second interpreter, whose sink adds up
// what the machine would do. Context: main loop.
#include "gcode/gcode_survey.h"

#include <math.h>
#include <string.h>

#include "gcode/gcode_file.h"
#include "gcode/gcode_interpreter.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_estimate.h"
#include "stepper/stepper_homing.h"
#include "stepper/stepper_outputs.h"

#define LINES_PER_TURN 8u
#define MS_PER_S 1000.0

typedef struct {
    gcode_interpreter_t interpreter;
    stepper_estimate_t estimate;
    gcode_file_t file;
    gcode_report_t *report;
    double place[AXIS_COUNT];      // where the last entry ended
    uint32_t line_axes;            // that move in the line being read
    gcode_range_t way[AXIS_COUNT]; // in that line, machine coordinates
    stepper_turn_t spindle;        // as it was switched
    stepper_turn_t turning;        // the same, but off at a speed of 0
} survey_t;

_Static_assert(sizeof(survey_t) <= GCODE_SURVEY_SIZE, "GCODE_SURVEY_SIZE is too small");

static survey_t *survey; // the one under way

// ---- Where it leads -----------------------------------------------------------------------------

static void extend(gcode_range_t *range, bool first, double low, double high) {
    range->low = first ? low : fmin(range->low, low);
    range->high = first ? high : fmax(range->high, high);
}

static void follow_axis(axis_id_t axis, double low, double high) {
    uint32_t bit = 1u << axis;
    extend(&survey->way[axis], (survey->line_axes & bit) == 0, low, high);
    survey->line_axes |= bit;
    if (survey->report->beyond_line == 0 && stepper_is_beyond(axis, low, high)) {
        survey->report->beyond_line = survey->file.line;
        survey->report->beyond_axis = axis;
    }
}

// What the line did is added when its offsets are in force.
static void add_line(void) {
    gcode_report_t *report = survey->report;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        uint32_t bit = 1u << axis;
        if (survey->line_axes & bit) {
            const gcode_range_t *way = &survey->way[axis];
            double offset = survey->interpreter.state.offset[axis];
            bool first = (report->axes & bit) == 0;
            extend(&report->machine[axis], first, way->low, way->high);
            extend(&report->work[axis], first, way->low - offset, way->high - offset);
        }
    }
    report->axes |= survey->line_axes;
    survey->line_axes = 0;
}

static void follow_line(const stepper_move_t *move) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double from = survey->place[axis];
        double to = move->target[axis];
        if (from != to) {
            follow_axis(axis, fmin(from, to), fmax(from, to));
        }
    }
    stepper_estimate_line(&survey->estimate, move);
    survey->report->moves++;
    memcpy(survey->place, move->target, sizeof survey->place);
}

static err_t follow_arc(const stepper_arc_t *arc) {
    double low[AXIS_COUNT], high[AXIS_COUNT];
    err_t err = stepper_estimate_arc(&survey->estimate, arc, low, high);
    if (err != ERR_OK) {
        return err;
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (low[axis] != high[axis]) {
            follow_axis(axis, low[axis], high[axis]);
        }
    }
    survey->report->moves++;
    memcpy(survey->place, arc->move.target, sizeof survey->place);
    return ERR_OK;
}

// ---- The sink -----------------------------------------------------------------------------------

static void target(double place[AXIS_COUNT]) {
    memcpy(place, survey->place, sizeof survey->place);
}

static err_t place(double here[AXIS_COUNT]) {
    target(here);
    return ERR_OK;
}

// What can be known of an entry without its surroundings; the shape of an arc is looked at when it
// is followed.
static err_t check(const gcode_entry_t *entry, double from[AXIS_COUNT]) {
    switch (entry->kind) {
    case ENTRY_MOVE:
    case ENTRY_ARC:
    case ENTRY_PROBE:
        memcpy(from, entry->arc.move.target, sizeof entry->arc.move.target);
        return ERR_OK;
    case ENTRY_SPINDLE:
        return stepper_spindle_check(entry->spindle.turn);
    case ENTRY_COOLANT:
        return stepper_coolant_check(entry->coolant.flood, entry->coolant.mist);
    default:
        return ERR_OK;
    }
}

// The spindle needs its time when it starts or turns round.
static void switch_spindle(stepper_turn_t turn, double rpm) {
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    bool turns = rpm > 0.0 || outputs.spindle.max_rpm <= 0.0;
    stepper_turn_t turning = turns ? turn : STEPPER_SPINDLE_OFF;
    bool starts = turning != STEPPER_SPINDLE_OFF && turning != survey->turning;
    double seconds = starts ? (double)outputs.spindle.spinup_ms / MS_PER_S : 0.0;
    if (!outputs.laser) {
        stepper_estimate_pause(&survey->estimate, seconds);
    }
    survey->turning = turning;
    survey->spindle = turn;
}

static void home(uint32_t axes) {
    survey->report->homings++;
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        stepper_home_t settings;
        stepper_home_settings(axis, &settings);
        bool named = axes == 0 || ((axes >> axis) & 1) != 0;
        if (named && settings.end != STEPPER_HOME_AUTO && stepper_axis_configured(axis)) {
            survey->place[axis] = settings.position_mm;
        }
    }
    stepper_estimate_place(&survey->estimate, survey->place);
}

static err_t push(const gcode_entry_t *entry) {
    switch (entry->kind) {
    case ENTRY_MOVE:
        follow_line(&entry->arc.move);
        break;
    case ENTRY_ARC:
        return follow_arc(&entry->arc);
    case ENTRY_PROBE:
        survey->report->probings++;
        follow_line(&entry->arc.move);
        stepper_estimate_pause(&survey->estimate, 0.0);
        break;
    case ENTRY_DWELL:
        stepper_estimate_pause(&survey->estimate, entry->dwell.ms / MS_PER_S);
        break;
    case ENTRY_SPINDLE:
        switch_spindle(entry->spindle.turn, entry->spindle.rpm);
        break;
    case ENTRY_PAUSE:
        survey->report->pauses++;
        stepper_estimate_pause(&survey->estimate, 0.0);
        break;
    case ENTRY_COOLANT:
        stepper_estimate_pause(&survey->estimate, 0.0);
        break;
    case ENTRY_HOME:
        home(entry->axes);
        break;
    case ENTRY_END:
        break;
    }
    return ERR_OK;
}

static bool ended(err_t *result) {
    *result = ERR_OK;
    return true;
}

static uint32_t drops(void) {
    return 0;
}

static gcode_outputs_t outputs(void) {
    return (gcode_outputs_t){.spindle = survey->spindle};
}

static void tell(const char *text, size_t length) {
    (void)text;
    (void)length;
}

static const gcode_sink_t sink = {
    .target = target,
    .place = place,
    .check = check,
    .push = push,
    .ended = ended,
    .drops = drops,
    .outputs = outputs,
    .tell = tell,
};

// ---- The file -----------------------------------------------------------------------------------

static err_t read_line(const gcode_file_t *file) {
    gcode_interpreter_t *in = &survey->interpreter;
    err_t err = gcode_interpreter_line(in, gcode_file_text(file), gcode_file_length(file));
    if (err == ERR_OK) {
        err = gcode_interpreter_failure(in);
    }
    add_line();
    while (err == ERR_OK && in->busy) { // behind homing and probing
        gcode_interpreter_background(in);
        err = gcode_interpreter_failure(in);
        add_line();
    }
    return err;
}

static err_t read_file(bool (*go_on)(void)) {
    gcode_file_t *file = &survey->file;
    bool more = true;
    err_t err = ERR_OK;
    while (err == ERR_OK && more && !survey->interpreter.ended) {
        err = gcode_file_next(file, &more);
        survey->report->lines = file->line;
        if (err == ERR_OK && more) {
            err = read_line(file);
        }
        if (file->line % LINES_PER_TURN == 0) {
            err_kept_t kept;
            err_keep(&kept);
            more = go_on() && more;
            err_put_back(&kept);
        }
    }
    return err;
}

// The machine as it will be when all that is queued has been carried out.
static void begin(gcode_report_t *report) {
    survey->report = report;
    gcode_interpreter_start(&survey->interpreter, &sink);
    survey->interpreter.state = gcode_live.state;
    survey->spindle = (stepper_turn_t)gcode_live.state.modal.spindle;
    survey->turning =
        survey->interpreter.state.modal.rpm > 0.0 ? survey->spindle : STEPPER_SPINDLE_OFF;
    stepper_target(survey->place);
    stepper_estimate_start(&survey->estimate, survey->place);
}

err_t gcode_survey(void *memory, const char *name, size_t length, bool (*go_on)(void),
                   gcode_report_t *report) {
    memset(report, 0, sizeof *report);
    if (stepper_active() < 0) {
        return err_raise(ERR_STEPPER_NOT_INITIALIZED, NULL);
    }
    survey = memory;
    err_t err = gcode_file_open(&survey->file, name, length);
    if (err != ERR_OK) {
        return err;
    }
    begin(report);
    err = read_file(go_on);
    gcode_file_close(&survey->file);
    report->seconds = stepper_estimate_seconds(&survey->estimate);
    return err;
}
