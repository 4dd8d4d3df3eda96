// An interpreter of G-code lines: a state and a sink. The machine has one (gcode.c); another, on a
// copy of the state, can look through a file without moving anything. Inside gcode/ only. Context:
// main loop.
#ifndef GCODE_INTERPRETER_H
#define GCODE_INTERPRETER_H

#include "gcode/gcode_plan.h"
#include "gcode/gcode_sink.h"

typedef struct {
    const gcode_sink_t *sink;
    gcode_state_t state;
    gcode_plan_t pending; // of an accepted line; meaningful with `busy`
    bool begun;           // something of it has been done
    bool busy;            // steps of `pending` are left, or it waits
    bool waits;           // for the end of homing or probing
    bool ended;           // M2 or M30
    err_kept_t failure;   // of what was pending, not told yet
    uint32_t drops;       // of the sink, when it was asked last
} gcode_interpreter_t;

// Modes as after power-up; offsets 0.
void gcode_interpreter_start(gcode_interpreter_t *interpreter, const gcode_sink_t *sink);

// See gcode.h.
err_t gcode_interpreter_line(gcode_interpreter_t *interpreter, const char *text, size_t length);
err_t gcode_interpreter_words(gcode_interpreter_t *interpreter, const gcode_word_t *words,
                              size_t count);
void gcode_interpreter_background(gcode_interpreter_t *interpreter);
err_t gcode_interpreter_failure(gcode_interpreter_t *interpreter);

extern gcode_interpreter_t gcode_live; // the machine's

#endif
