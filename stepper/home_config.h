// How each axis is homed and in which order. Inside stepper/ only. Context: main loop.
#ifndef STEPPER_HOME_CONFIG_H
#define STEPPER_HOME_CONFIG_H

#include "stepper/stepper_homing.h"

// As after INIT: all defaults.
void home_config_reset(void);

// The switch that the axis homes to. False: it has none.
typedef struct {
    bool max;     // at the upper end
    bool shared;  // its pin is that of the other end's as well
    bool high;    // level of its pin when it is closed
    uint32_t bit; // its number in stepper_switch_t as a mask
    uint32_t pin; // mask
} home_switch_t;
bool home_config_switch(axis_id_t axis, home_switch_t *found);

// An axis of `group` that stands on a switch which may be that of the other end; leaving it could
// be running into it. STEPPER_HOME_AXES: none.
axis_id_t home_config_on_either_end(uint32_t group);

// Errors: axis not configured, no switch.
err_t home_config_check(axis_id_t axis);

// Somebody has chosen the latch feed of the axis.
bool home_config_latch_is_set(axis_id_t axis);

home_switch_t home_config_switch_of(axis_id_t axis); // of one that has one

// Whether it is closed now; those of `group` (axes) whose switch is.
bool home_config_is_closed(axis_id_t axis);
uint32_t home_config_closed(uint32_t group);

// The axes that have one.
uint32_t home_config_all(void);

// The axes of `left` (mask, not 0) that are homed next, together.
uint32_t home_config_next(uint32_t left);

// How long an axis takes to its seek feed, and its way until then, with a reserve. A driver
// measures the load of its motor once in a full step and at speed only: a stall that it shows
// before may be none.
uint32_t home_config_speed_up_us(axis_id_t axis);
double home_config_speed_up_mm(axis_id_t axis);

#endif
