// What a new move is like: its direction, its length and what the axes allow along it. Inside stepper/
// only. Context: main loop.
#ifndef STEPPER_GEOMETRY_H
#define STEPPER_GEOMETRY_H

#include "stepper/stepper.h"

// What the limits are projected from; applies to moves queued from now on.
typedef struct {
    float deviation; // junction deviation, mm
    bool scurve;
    float jerk;                  // along the path, units/s^3
    float axis_jerk[AXIS_COUNT]; // 0: none of its own
} geometry_settings_t;

extern geometry_settings_t geometry_settings;

typedef struct {
    float start[AXIS_COUNT]; // unit vectors along the path
    float end[AXIS_COUNT];
    float length;       // in all axes, units
    float axes_speed;   // units/s
    float feed;         // units/s along the path, 0: rapid
    float acceleration; // units/s^2
    float jerk;         // units/s^3; 0: trapezoid
} geometry_t;

// A line by `delta` units.
void geometry_line(geometry_t *g, const double delta[AXIS_COUNT], const stepper_move_t *move);

// The square of the speed that the corner between two moves allows, at most FLT_MAX.
float geometry_corner_speed2(const geometry_t *before, const geometry_t *next,
                             stepper_corner_t corner);

// In S-curve mode: limits of a short move as they are in all directions near its own, so that they stay
// the same over a curve made of chords.
void geometry_even_out(geometry_t *g);

#endif
