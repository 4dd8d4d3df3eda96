// A sink that writes down the entries it gets, as text, instead of carrying them out.
#ifndef RECORDER_H
#define RECORDER_H

#include "gcode/gcode_interpreter.h"

#define RECORDER_SIZE 2000

typedef struct {
    gcode_interpreter_t interpreter;
    char text[RECORDER_SIZE]; // entries since recorder_take(), "; " between them
    char message[100];        // of the last (MSG,...)
    double target[AXIS_COUNT];
    uint32_t room;  // entries that are still taken; UINT32_MAX: any number
    uint32_t drops; // tests raise it
    stepper_turn_t spindle;
    err_t fails;  // all pushes, with this
    bool ended;   // homing or probing has ended
    err_t result; // with this
} recorder_t;

extern recorder_t recorder;

// A fresh interpreter at 0, with room for everything.
void recorder_start(void);

// Sends a line; the entries are in recorder.text.
err_t recorder_send(const char *line);

// Empties the text.
void recorder_clear(void);

#endif
