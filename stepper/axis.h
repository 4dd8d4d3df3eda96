// The axes' configuration in the form the planner wants. Inside stepper/ only. Context: main loop.
#ifndef STEPPER_AXIS_H
#define STEPPER_AXIS_H

#include "stepper/stepper.h"

// Positions stay well inside int32, so that differences of two positions fit as well.
#define AXIS_STEPS_MAX 1.0e9

typedef struct {
    bool configured;
    bool limited; // soft limits are set
    stepper_axis_t config;
    float velocity;     // units/s, also within the 50 kHz step rate
    float acceleration; // units/s^2
    double min, max;    // soft limits, units
} axis_t;

extern axis_t axes[AXIS_COUNT];

// Takes the pins and keeps the configuration, or fails and changes nothing.
err_t axis_configure(axis_id_t axis, const stepper_axis_t *config);

// Another configuration of an axis that keeps its pins and limits.
void axis_tune(axis_id_t axis, const stepper_axis_t *config);

// Gives the pins of all axes back and forgets them.
void axis_release_all(void);

// The one rounding from units to steps. False if it does not fit.
bool axis_to_steps(axis_id_t axis, double position, int32_t *steps);
double axis_from_steps(axis_id_t axis, int32_t steps);

// Pins of all configured axes.
uint32_t axis_enable_mask(void);
uint32_t axis_step_mask(axis_id_t axis);

#endif
