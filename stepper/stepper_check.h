// Whether a move could be queued, without queuing it: a line of G-code that needs several entries
// is checked as a whole before the first is queued. A further face of stepper/, beside stepper.h.
// Context: main loop.
#ifndef STEPPER_CHECK_H
#define STEPPER_CHECK_H

#include "stepper/stepper.h"

// Error: the axis is not configured.
err_t stepper_check_axis(axis_id_t axis);

// Whether the way from `low` to `high` exceeds the soft limits of a configured axis.
bool stepper_is_beyond(axis_id_t axis, double low, double high);

// Errors of stepper_move() and stepper_arc() from `from`, except that there is no room.
err_t stepper_check_line(const double from[AXIS_COUNT], const stepper_move_t *move);
err_t stepper_check_arc(const double from[AXIS_COUNT], const stepper_arc_t *arc);

// The way of an arc in X, Y and Z together, in mm, which its feed is about. Errors: as
// stepper_arc(), for its shape.
err_t stepper_arc_way(const double from[AXIS_COUNT], const stepper_arc_t *arc, double *way_mm);

#endif
