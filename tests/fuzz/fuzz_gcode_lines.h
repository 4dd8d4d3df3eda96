// G-code lines: right ones, whose effect is known, and others.
#ifndef FUZZ_GCODE_LINES_H
#define FUZZ_GCODE_LINES_H

#include <stdbool.h>
#include <stdint.h>

#include "fuzz_text.h"
#include "stepper/stepper.h"

typedef enum {
    FUZZ_GCODE_NOTHING,
    FUZZ_GCODE_MOVE,
    FUZZ_GCODE_DWELL,
    FUZZ_GCODE_OFFSET,       // G92
    FUZZ_GCODE_OFFSET_CLEAR, // G92.1
    FUZZ_GCODE_SYSTEM,       // G10 L2
    FUZZ_GCODE_LENGTH,       // G43.1 or G49
    FUZZ_GCODE_SPINDLE
} fuzz_gcode_kind_t;

#define FUZZ_GCODE_SYSTEMS 9u

// A right line, as it is meant.
typedef struct {
    fuzz_gcode_kind_t kind;
    bool sets_motion;         // G0 or G1 in the line
    bool rapid;               // which
    bool sets_distance;       // G90 or G91
    bool relative;            // which
    bool sets_units;          // G20 or G21
    bool inches;              // which
    bool sets_system;         // G54..G59.3
    uint32_t system;          // which, 0..8
    bool machine;             // G53
    uint32_t axes;            // bit n: axis n has a word
    double value[AXIS_COUNT]; // mm or degrees
    uint32_t table;           // P of G10: 0, or 1 + the system
    double length_mm;         // of the tool
    double feed;              // 0: none
    bool arc;                 // G2 or G3, which is then in force
} fuzz_gcode_line_t;

// What is in force before the line.
typedef struct {
    bool has_motion;
    bool rapid;
    bool relative;
    bool inches;
    uint32_t system; // 0..8
    bool has_feed;
    bool spindle; // there is a spindle pin
    bool fine;    // moves are very short and fast
} fuzz_gcode_modal_t;

// Makes a line that has to be accepted and fits `modal`; the axes must be configured, and targets
// stay within 60 units of zero if they began there.
void fuzz_gcode_right_line(fuzz_text_t *text, fuzz_gcode_line_t *line,
                           const fuzz_gcode_modal_t *modal, const double work_position[AXIS_COUNT]);

// Makes a line of words that each look right, in any combination.
void fuzz_gcode_any_line(fuzz_text_t *text);

#endif
