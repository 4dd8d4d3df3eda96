// What a new move is like: its direction, its length and what the axes allow along it. Inside
// stepper/ only. Context: main loop.
#ifndef STEPPER_GEOMETRY_H
#define STEPPER_GEOMETRY_H

#include "stepper/stepper.h"

// What the limits are projected from; applies to moves queued from now on.
typedef struct {
    float deviation;     // junction deviation, mm
    float arc_tolerance; // mm
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

// Speed, acceleration and jerk within the limits of the axes, of whose way each has at most this
// share.
void geometry_project_limits(geometry_t *g, const float share[AXIS_COUNT]);

// The fastest that the move is meant to be, units/s.
float geometry_top_speed(const geometry_t *g);

// How much of the acceleration may be used to turn, 0..1, if `needed` is used at
// geometry_top_speed(). The speed is limited by it, and the change of speed by what it leaves.
float geometry_turning_share(float needed, float most);

// A line by `delta` units.
void geometry_line(geometry_t *g, const double delta[AXIS_COUNT], const stepper_move_t *move);

// The parabola between two lines that leaves the corner by at most `tolerance_mm`; it begins and
// ends `reach` from the corner, which is less than half of each line. False: the corner is better
// passed as it is.
bool geometry_blend(geometry_t *g, const geometry_t *before, const geometry_t *next,
                    float tolerance_mm, float *reach);

// A length as 2^-32 of a line, and what is left of the line when such parts are cut off both ends.
uint32_t geometry_fraction(const geometry_t *line, float length);
float geometry_part(const geometry_t *line, uint32_t lead_in, uint32_t lead_out);

// The square of the speed that the corner between two moves allows, at most FLT_MAX.
float geometry_corner_speed2(const geometry_t *before, const geometry_t *next,
                             stepper_corner_t corner);

// In S-curve mode: limits of a short move as they are in all directions near its own, so that they
// stay the same over a curve made of chords.
void geometry_even_out(geometry_t *g);

#endif
