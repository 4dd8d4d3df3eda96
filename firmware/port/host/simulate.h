// What hangs at the simulated pins: observers that are told about every edge; among them axes that
// count steps as a motor driver would, and switches that such an axis presses, with what makes real
// ones difficult. Context: any (called where the edge is made).
#ifndef SIMULATE_H
#define SIMULATE_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal.h"

#define SIMULATE_OBSERVERS_MAX 20

// `changed`: the pins with an edge; `levels`: all pins after it.
typedef void (*simulate_observer_t)(void *state, uint64_t time_ns, uint32_t changed,
                                    uint32_t levels);

// Adds an observer, called from now on with its `state`. False if there is no room.
bool simulate_observe(simulate_observer_t observer, void *state);

// Tells all observers. For host_pads.c.
void simulate_edges(uint64_t time_ns, uint32_t changed, uint32_t levels);

typedef enum {
    SIMULATE_FAULT_NONE,
    SIMULATE_FAULT_MISS_STEPS,   // every `fault_every`-th step pulse does not move the axis
    SIMULATE_FAULT_NEVER_CLOSES, // a switch with a broken wire
    SIMULATE_FAULT_NEVER_OPENS,  // a switch that is stuck
} simulate_fault_t;

// A driver and its motor: a rising edge of `step` moves it one step, up while `dir` is high. Fill
// in the first group, then simulate_axis_attach().
typedef struct {
    unsigned step_gpio;
    unsigned dir_gpio;
    bool dir_inverted;      // dir low counts up
    simulate_fault_t fault; // may be changed at any time
    uint32_t fault_every;   // pulses, at least 1
    bool has_stops;         // the axis ends at the two that follow: a step beyond is lost
    int64_t stop_low_steps, stop_high_steps;

    // What moves the axis at a pulse, instead of one step; NULL: nothing. It sets position_steps.
    void (*mover)(void *state, uint64_t time_ns, bool up);
    void *mover_state;

    int64_t position_steps; // where the axis is
    uint64_t pulses;        // rising edges seen, missed ones included
    uint64_t last_step_ns;  // time of the last pulse; 0: none yet
} simulate_axis_t;

// Starts counting at the position in `axis`, which must stay valid. False if there is no room.
bool simulate_axis_attach(simulate_axis_t *axis);

// A limit switch that the axis presses from one position to another. Fill in the first group, then
// attach.
typedef struct {
    const simulate_axis_t *axis;
    unsigned gpio;
    int64_t from_steps, to_steps; // pressed here, ends included
    bool pressed_level;           // of the pin
    simulate_fault_t fault;       // may be changed at any time
    uint32_t hysteresis_steps;    // it opens so many steps further out than it closes
    uint32_t bounce_us;           // for so long behind each change the contact opens and closes
    // The output of a driver that notices stalls: it is active only while steps come at this rate
    // or faster within the range, and for `hold_us` behind such a step. 0: a plain switch.
    uint32_t stall_rate_hz, hold_us;

    bool pressed;          // it has been pressed and not yet left; bounces apart
    bool closed;           // the contact as it is now
    uint64_t edge_ns;      // of the next bounce or the end of a stall; 0: none
    uint64_t calm_ns;      // bounces end here
    uint64_t last_step_ns; // of the axis, for its rate
    uint32_t random;       // of the bounces
} simulate_switch_t;

// Drives the pin from now on; the axis has to be attached before. The switch must stay valid. False
// if there is no room.
bool simulate_switch_attach(simulate_switch_t *limit);

// Time of the next edge that a switch makes by itself, UINT64_MAX: none; and making those due at
// `now_ns`.
uint64_t simulate_switch_next_ns(void);
void simulate_switch_run(uint64_t now_ns);

// The same of all that is simulated here. For host_clock.c.
uint64_t simulate_next_ns(void);
void simulate_run(uint64_t now_ns);

#endif
