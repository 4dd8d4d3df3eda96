// Where G-code lines are carried out: on the machine, or on something that only looks at them. A
// line becomes entries, one after the other. Inside gcode/ only. Context: main loop.
#ifndef GCODE_SINK_H
#define GCODE_SINK_H

#include "gcode/gcode.h"
#include "stepper/stepper_outputs.h"

typedef enum {
    ENTRY_MOVE,    // arc.move
    ENTRY_ARC,     // arc
    ENTRY_PROBE,   // arc.move, probe
    ENTRY_DWELL,   // dwell
    ENTRY_SPINDLE, // spindle
    ENTRY_COOLANT, // coolant
    ENTRY_PAUSE,   // tool: the one to change to, GCODE_NO_TOOL for M0 and M1
    ENTRY_HOME,    // axes
    ENTRY_END      // M2 and M30; all that belongs to them was pushed before
} gcode_entry_kind_t;

typedef struct {
    gcode_entry_kind_t kind;
    stepper_arc_t arc;
    union {
        struct {
            bool toward;        // until contact; else until there is none
            bool error_if_none; // the end of the way without it is an error
        } probe;
        struct {
            double ms;
            bool lit; // a laser of constant power goes on
        } dwell;
        struct {
            stepper_turn_t turn;
            double rpm;
        } spindle;
        struct {
            bool flood, mist;
        } coolant;
        uint32_t tool;
        uint32_t axes; // bit n: axis n
    };
} gcode_entry_t;

typedef struct {
    stepper_turn_t spindle;
    bool flood, mist;
} gcode_outputs_t;

// One for each interpreter. Errors as err_t, raised by whoever finds them.
typedef struct {
    // Where the last entry ended, machine coordinates.
    void (*target)(double target[AXIS_COUNT]);
    // The same for a line that gives this place a name, such as G92; error: it is not known.
    err_t (*place)(double target[AXIS_COUNT]);
    // Whether the entry could be carried out from `from`, room in the queue apart. Nothing is
    // changed. `from` is advanced to where it ends.
    err_t (*check)(const gcode_entry_t *entry, double from[AXIS_COUNT]);
    // Carries the entry out, or queues it. ERR_GCODE_BUFFER_FULL: nothing was done, try again
    // later.
    err_t (*push)(const gcode_entry_t *entry);
    // After ENTRY_HOME and ENTRY_PROBE were pushed: true once they have ended, with their error.
    bool (*ended)(err_t *result);
    // Counts how often what was queued has been dropped.
    uint32_t (*drops)(void);
    // What spindle and coolant do, after a drop.
    gcode_outputs_t (*outputs)(void);
    // A text of the line for the user: of (MSG,...), `length` bytes.
    void (*tell)(const char *text, size_t length);
} gcode_sink_t;

extern const gcode_sink_t gcode_machine;

#endif
