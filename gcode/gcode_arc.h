// Arcs of G2 and G3. Inside gcode/ only. Context: main loop.
#ifndef GCODE_ARC_H
#define GCODE_ARC_H

#include "gcode/gcode_words.h"

// Fills in the plane, the centre, the direction and the turns that the line asks for; the move's
// target is known.
err_t gcode_arc_find(stepper_arc_t *arc, const line_t *line, const gcode_state_t *state,
                     const double from[AXIS_COUNT]);

#endif
