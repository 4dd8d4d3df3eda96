// What G-code remembers from line to line: the modal state, and the offsets between work and
// machine coordinates. Lengths are in mm whatever G20 said. Inside gcode/ only. Context: main loop.
#ifndef GCODE_STATE_H
#define GCODE_STATE_H

#include "gcode/gcode.h"
#include "stepper/stepper_outputs.h"

#define GCODE_MM_PER_INCH 25.4

// Modal group 1. Those from MOTION_CYCLE_CHIPS on are canned cycles.
typedef enum {
    MOTION_NONE, // G80, and after power-up
    MOTION_RAPID,
    MOTION_FEED,
    MOTION_ARC_CW,
    MOTION_ARC_CCW,
    MOTION_PROBE_TO,        // G38.2: towards contact, none is an error
    MOTION_PROBE_TO_MAYBE,  // G38.3
    MOTION_PROBE_OFF,       // G38.4: away, until contact is lost
    MOTION_PROBE_OFF_MAYBE, // G38.5
    MOTION_CYCLE_CHIPS,     // G73
    MOTION_CYCLE_DRILL,     // G81
    MOTION_CYCLE_DWELL,     // G82
    MOTION_CYCLE_PECK       // G83
} motion_t;

// The plane of arcs: G17, G18, G19.
typedef enum { PLANE_XY, PLANE_ZX, PLANE_YZ } plane_t;

typedef struct {
    uint8_t motion;       // motion_t
    uint8_t plane;        // plane_t
    uint8_t system;       // 0..8: G54..G59.3
    uint8_t spindle;      // stepper_turn_t, as of the last entry queued
    bool relative;        // G91
    bool centre_absolute; // G90.1
    bool inches;          // G20
    bool inverse_time;    // G93
    bool retract_to_r;    // G99
    bool shifted;         // the offsets of G92 count
    bool feed_in_inches;  // F was given with G20 in force
    bool flood, mist;     // M8, M7
    gcode_path_t path;
    double feed;           // mm/min, for A alone degrees/min; 0: not set
    double rpm;            // S
    double tool_length_mm; // G43, G43.1
    uint32_t tool;         // in the spindle: the T of the last M6
    uint32_t next_tool;    // T
} modal_t;

#define GCODE_SYSTEMS 9u
#define GCODE_TOOLS 16u

// Places that G28.1 and G30.1 have stored.
typedef enum { STORED_G28, STORED_G30, STORED_COUNT } stored_t;

// What the lines of a canned cycle have set; see gcode_cycle.h.
typedef struct {
    double z, r, q, p; // words, which stay until the cycle ends; mm, p in ms
    double initial_z;  // machine coordinate at which the first of a series of cycles began
    uint8_t motion;    // motion_t of the line that set them
} gcode_cycle_words_t;

typedef struct {
    modal_t modal;
    double offset[AXIS_COUNT]; // machine = work + offset: the sum of all below that are in force
    double systems[GCODE_SYSTEMS][AXIS_COUNT];
    double shift[AXIS_COUNT]; // G92
    double stored[STORED_COUNT][AXIS_COUNT];
    bool has_stored[STORED_COUNT];
    double tool_lengths_mm[GCODE_TOOLS]; // of tools 1..GCODE_TOOLS
    gcode_cycle_words_t cycle;
    gcode_options_t options;
} gcode_state_t;

#endif
