// Arcs: what stepper_arc() asks for, in numbers that can be planned and followed. Inside stepper/
// only. Context: main loop, if a function says nothing else.
#ifndef STEPPER_ARC_H
#define STEPPER_ARC_H

#include "stepper/geometry.h"
#include "stepper/moves.h"
#include "stepper/planner.h"

struct arc {
    axis_id_t plane[2];
    double centre[2];        // machine coordinates, units
    double start[2], end[2]; // from the centre, units
    double radius;           // mean of start and end, units
    double turns;            // > 0 counter-clockwise
};

// Measures the arc that begins at `from`. Errors: see stepper_arc().
err_t arc_measure(arc_t *arc, const stepper_arc_t *wanted, const double from[AXIS_COUNT]);

// How far the way goes behind its start, along the n-th axis of the plane, in machine coordinates.
void arc_extent(const arc_t *arc, unsigned n, double *low, double *high);

// The way in its plane, units.
double arc_way(const arc_t *arc);

// No motor has to move for it, provided that its end is at the step where it starts.
bool arc_is_below_a_step(const arc_t *arc);

// What the arc is like for the planner. `delta` is the way of each axis.
void arc_geometry(geometry_t *g, const arc_t *arc, const double delta[AXIS_COUNT],
                  const stepper_move_t *move);

// Fills in what the block keeps of the arc.
void arc_fill(block_t *block, const arc_t *arc);

// Planes are numbered by their first axis. Any context.
static inline uint32_t arc_plane_of(const axis_id_t plane[2]) {
    return (uint32_t)plane[0];
}

static inline axis_id_t arc_plane_axis(uint32_t plane, unsigned n) {
    return (axis_id_t)(n == 0 ? plane : (plane + 1) % 3);
}

#endif
