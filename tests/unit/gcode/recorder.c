#include "recorder.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

recorder_t recorder;

static void note(const char *format, ...) __attribute__((format(printf, 1, 2)));

static void note(const char *format, ...) {
    size_t used = strlen(recorder.text);
    va_list args;
    va_start(args, format);
    vsnprintf(recorder.text + used, sizeof recorder.text - used, format, args);
    va_end(args);
}

static void note_move(const stepper_move_t *move) {
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        note(" %.9g", move->target[axis]);
    }
    if (!move->rapid) {
        note(" F%.9g", move->feed);
    }
    if (move->sets_spindle) {
        note(" S%.9g", move->spindle_rpm);
    }
    switch (move->corner) {
    case STEPPER_CORNER_CONTINUOUS:
        break;
    case STEPPER_CORNER_EXACT:
        note(" exact");
        break;
    case STEPPER_CORNER_STOP:
        note(" stop");
        break;
    case STEPPER_CORNER_BLEND:
        note(" blend %.9g", move->blend_mm);
        break;
    }
}

static void note_arc(const stepper_arc_t *arc) {
    note(arc->clockwise ? "cw" : "ccw");
    note_move(&arc->move);
    note(" centre %c%.9g %c%.9g", STEPPER_AXIS_LETTERS[arc->plane[0]], arc->centre[0],
         STEPPER_AXIS_LETTERS[arc->plane[1]], arc->centre[1]);
    if (arc->turns != 1) {
        note(" turns %u", (unsigned)arc->turns);
    }
}

static void note_entry(const gcode_entry_t *entry) {
    static const char *const turns[] = {"off", "cw", "ccw"};
    note(recorder.text[0] != '\0' ? "; " : "");
    switch (entry->kind) {
    case ENTRY_MOVE:
        note(entry->arc.move.rapid ? "rapid" : "line");
        note_move(&entry->arc.move);
        break;
    case ENTRY_ARC:
        note_arc(&entry->arc);
        break;
    case ENTRY_PROBE:
        note("probe %s%s", entry->probe.toward ? "to" : "off",
             entry->probe.error_if_none ? "" : " maybe");
        note_move(&entry->arc.move);
        break;
    case ENTRY_DWELL:
        note(entry->dwell.lit ? "dwell %.9g lit" : "dwell %.9g", entry->dwell.ms);
        break;
    case ENTRY_SPINDLE:
        note("spindle %s %.9g", turns[entry->spindle.turn], entry->spindle.rpm);
        break;
    case ENTRY_COOLANT:
        note("coolant%s%s%s", entry->coolant.flood ? " flood" : "",
             entry->coolant.mist ? " mist" : "",
             entry->coolant.flood || entry->coolant.mist ? "" : " off");
        break;
    case ENTRY_PAUSE:
        if (entry->tool != GCODE_NO_TOOL) {
            note("tool %u", (unsigned)entry->tool);
        } else {
            note("pause");
        }
        break;
    case ENTRY_HOME:
        note("home %u", (unsigned)entry->axes);
        break;
    case ENTRY_END:
        note("end");
        break;
    }
}

static void target(double place[AXIS_COUNT]) {
    memcpy(place, recorder.target, sizeof recorder.target);
}

static err_t place(double at[AXIS_COUNT]) {
    target(at);
    return ERR_OK;
}

static bool moves(const gcode_entry_t *entry) {
    return entry->kind == ENTRY_MOVE || entry->kind == ENTRY_ARC || entry->kind == ENTRY_PROBE;
}

// Beyond 1000 there is nothing.
static err_t check(const gcode_entry_t *entry, double from[AXIS_COUNT]) {
    if (!moves(entry)) {
        return ERR_OK;
    }
    memcpy(from, entry->arc.move.target, sizeof entry->arc.move.target);
    return from[AXIS_X] > 1000.0 ? err_raise(ERR_SOFT_LIMIT, "X") : ERR_OK;
}

static err_t push(const gcode_entry_t *entry) {
    double from[AXIS_COUNT];
    if (recorder.fails != ERR_OK) {
        return err_raise(recorder.fails, "%s", "");
    }
    if (recorder.room == 0) {
        return err_raise(ERR_GCODE_BUFFER_FULL, NULL);
    }
    err_t err = check(entry, from);
    if (err != ERR_OK) {
        return err;
    }
    if (recorder.room != UINT32_MAX) {
        recorder.room--;
    }
    note_entry(entry);
    if (moves(entry)) {
        memcpy(recorder.target, entry->arc.move.target, sizeof recorder.target);
    }
    if (entry->kind == ENTRY_SPINDLE) {
        recorder.spindle = entry->spindle.turn;
    }
    return ERR_OK;
}

static bool ended(err_t *result) {
    bool failed = recorder.ended && recorder.result != ERR_OK;
    *result = failed ? err_raise(recorder.result, "%s", "") : ERR_OK;
    return recorder.ended;
}

static uint32_t drops(void) {
    return recorder.drops;
}

static gcode_outputs_t outputs(void) {
    return (gcode_outputs_t){.spindle = recorder.spindle};
}

static void tell(const char *text, size_t length) {
    snprintf(recorder.message, sizeof recorder.message, "%.*s", (int)length, text);
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

void recorder_start(void) {
    recorder = (recorder_t){.room = UINT32_MAX, .ended = true};
    gcode_interpreter_start(&recorder.interpreter, &sink);
}

void recorder_clear(void) {
    recorder.text[0] = '\0';
}

err_t recorder_send(const char *line) {
    recorder_clear();
    return gcode_interpreter_line(&recorder.interpreter, line, strlen(line));
}
