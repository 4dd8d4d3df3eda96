// Homing and probing: cycles of several moves that end at an input. A further face of stepper/,
// beside stepper.h. A cycle runs in the background, through the same queue, ramps and S-curves as
// every move: stepper_background() takes it from one move to the next. While one is under way new
// moves and jogs are refused. Whoever has to wait for its end asks stepper_cycle() and reads
// stepper_cycle_result() then. Context: main loop.
#ifndef STEPPER_STEPPER_HOMING_H
#define STEPPER_STEPPER_HOMING_H

#include "stepper/stepper.h"

typedef enum { STEPPER_CYCLE_NONE, STEPPER_CYCLE_HOMING, STEPPER_CYCLE_PROBING } stepper_cycle_t;

// The cycle under way.
stepper_cycle_t stepper_cycle(void);

// How the last cycle ended: ERR_OK, or its error, raised anew. ERR_OK while one is under way.
err_t stepper_cycle_result(void);

// Takes what is under way on; call it often, and while waiting.
void stepper_background(void);

// ---- Homing -------------------------------------------------------------------------------------
// A group of axes goes to its switches at the seek feed until the last of them has closed, backs
// off, goes there again at the latch feed, and pulls off. An axis then stands at its home position,
// `pull_off` away from the place where its switch closed, to the step. A switch that is pressed at
// the start is left first. A stall output (see `latch`) that rises before the axis can have its
// speed is doubted: the axis backs off by a run-up and goes there again.

#define STEPPER_HOME_AXES 3u // X, Y, Z

typedef enum { STEPPER_HOME_AUTO, STEPPER_HOME_MIN, STEPPER_HOME_MAX } stepper_home_end_t;

// 0 stands for the default, which may follow from the axis's configuration.
typedef struct {
    stepper_home_end_t end; // default: the minimum, unless only the maximum has a switch
    double seek;            // mm/min; half the axis's speed, at most 3000
    // mm/min, 0: no second approach. STEPPER_HOME_LATCH: a tenth of seek, 60 at least, and none if
    // the switch is active high and opens by itself when the axis stands: then it is a driver's
    // stall output. With 0, or with STEPPER_HOME_LATCH at an input that is active high, the first
    // approach ends without braking, and the axis is homed alone.
    double latch;
    double pull_off_mm;   // home_backoff_mm of the axis
    double max_travel_mm; // 1.5 times what the soft limits span, or 1000 without any
    double position_mm;   // machine position where homing ends
} stepper_home_t;

#define STEPPER_HOME_LATCH (-1.0)

// Sets all of it. Errors: not initialised, axis not configured, cycle under way.
err_t stepper_home_config(axis_id_t axis, const stepper_home_t *config);

// What would be used now, with the defaults filled in. `end` stays auto if the axis has no switch.
void stepper_home_settings(axis_id_t axis, stepper_home_t *settings);

// Which axes are homed one after another and which together. `groups` are masks of axes (bit 0: X),
// the first one first; axes in no group follow one by one. Default: Z, X, Y. Error: an axis in two
// groups.
err_t stepper_home_order(const uint8_t groups[STEPPER_HOME_AXES]);
void stepper_home_groups(uint8_t groups[STEPPER_HOME_AXES]);

// Begins to home `axes` (bit 0: X; 0: all that have a switch). What is queued is executed before;
// when not armed, the drivers are turned on, and stay on. The position need not be known. Errors:
// not initialised, an axis not configured or without a switch, moves wait for STEPPER RUN, E-STOP,
// another cycle, a jog or a stop is under way.
err_t stepper_home(uint32_t axes);

// Whether stepper_home() would be refused because of an axis or its switch; raises it.
err_t stepper_home_check(uint32_t axes);

// Whether the first approach of an axis that has a home switch ends without braking, as said at
// `latch` above: its input may be a driver's that has noticed a stall.
bool stepper_home_halts(axis_id_t axis);

// For STATUS: the axes of the group that is homed now, and what they do ("approaching").
const char *stepper_homing_phase(uint32_t *axes);

// Whoever has to make something ready before axes approach their switches: drivers that find the
// end of an axis without a switch are armed there, and disarmed behind it.
typedef enum {
    STEPPER_ARM_DONE,
    STEPPER_ARM_BUSY,  // ask again
    STEPPER_ARM_FAILED // an error has been raised
} stepper_arm_t;

typedef struct {
    // Whether `axes` can be homed, as far as the drivers go; raises why not.
    err_t (*check)(uint32_t axes);
    // Called from stepper_background() while the machine stands, again and again until it is not
    // busy; must not wait. If it fails, that is how the cycle ends. With `on` before an approach of
    // `axes`; without for the same axes behind it, and however the cycle ends: even if arming them
    // has failed or is still under way. Behind the end (stepper_cycle() is none) nobody looks at
    // the error of disarming: the function has to tell it.
    stepper_arm_t (*arm)(uint32_t axes, bool on);
} stepper_homing_hook_t;

// NULL: nobody. The hook has to stay valid.
void stepper_homing_set_hook(const stepper_homing_hook_t *hook);

// The hook still has to disarm what a cycle that has ended has left armed.
bool stepper_homing_disarms(void);

// ---- Probing ------------------------------------------------------------------------------------

// The probe's input; active low with pull-up, or high with pull-down if inverted. PINS_NONE takes
// it away. Refused while anything moves.
err_t stepper_probe_pin(uint8_t gpio, bool invert);

// Moves towards move->target until the probe makes contact, or with `away` until it has lost it;
// what is queued is executed before. Then brakes. The position of the change is kept, to the step.
// `must_change`: reaching the target without a change is the cycle's error; the probe's being in
// the wanted state at the start always is. Errors: as stepper_move() and stepper_home(); no probe
// pin, not armed, nothing of X, Y, Z to move.
err_t stepper_probe(const stepper_move_t *move, bool away, bool must_change);

// Where the probe changed in the last probing, machine coordinates; where the machine stood at its
// end, if it did not change. False: no change, or no probing yet.
bool stepper_probed(double position[AXIS_COUNT]);

// The configuration; PINS_NONE: there is no probe. And whether it has contact now.
uint8_t stepper_probe_config(bool *invert);
bool stepper_probe_contact(void);

#endif
