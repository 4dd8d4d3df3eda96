// Coordinate systems, G92, tool lengths and stored places. Inside gcode/ only. Context: main loop.
#ifndef GCODE_OFFSETS_H
#define GCODE_OFFSETS_H

#include "gcode/gcode_words.h"

// The line gives the place where the machine is a name (G92, G10 L20, G28.1, G30.1).
bool gcode_offsets_need_place(const line_t *line);

// What an accepted line changes in offsets and modes; `place` is meaningful if it was needed.
void gcode_offsets_commit(gcode_state_t *state, const line_t *line, const double place[AXIS_COUNT]);

// Machine = work + this, with the modes of `modal`: the state's, or those that a line will leave.
double gcode_offsets_of(const gcode_state_t *state, const modal_t *modal, axis_id_t axis);

// Sums up again what is in force.
void gcode_offsets_sum(gcode_state_t *state);

#endif
