// A model of what right lines do to the machine's target and to the origin of work coordinates.
#ifndef FUZZ_GCODE_MODEL_H
#define FUZZ_GCODE_MODEL_H

#include "fuzz_gcode_lines.h"

typedef struct {
    fuzz_gcode_modal_t modal;
    double target[AXIS_COUNT]; // machine coordinates
    double systems[FUZZ_GCODE_SYSTEMS][AXIS_COUNT];
    double shift[AXIS_COUNT]; // G92
    double length_mm;         // of the tool
    bool stop_pending;        // at its end the target will follow the motors
} fuzz_gcode_model_t;

extern fuzz_gcode_model_t fuzz_gcode_model;

// Work to machine coordinates, summed up as the reader does.
double fuzz_gcode_model_offset(axis_id_t axis);

// Where the machine's word is taken: after a stop, and after a line whose meaning the model does
// not know.
void fuzz_gcode_model_follow_machine(void);

void fuzz_gcode_model_follow(const fuzz_gcode_line_t *line);

// Fails unless machine and reader are where the model says.
void fuzz_gcode_model_check(void);

// All origins are where the machine's are.
void fuzz_gcode_model_clear_origins(void);

#endif
