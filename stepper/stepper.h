// Four stepper axes: configuration, the motion queue and what may be asked of it. The face of
// stepper/. Positions are machine coordinates: mm for X, Y, Z and degrees for A. Work offsets are
// G-code's business. Context: main loop, except hal_on_tick() and hal_on_governor(), which the port
// calls.
#ifndef STEPPER_H
#define STEPPER_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"
#include "hal/hal.h"

typedef enum { AXIS_X, AXIS_Y, AXIS_Z, AXIS_A, AXIS_COUNT } axis_id_t;
#define STEPPER_AXIS_LETTERS "XYZA" // indexed by axis_id_t

#define STEPPER_BLOCKS_MAX 1024u
#define STEPPER_BLOCKS_DEFAULT 32u
#define STEPPER_JUNCTION_DEVIATION_MM 0.02 // default
#define STEPPER_JERK_DEFAULT 10000.0       // mm/s^3
#define STEPPER_JERK_MIN 0.001             // units/s^3
#define STEPPER_JERK_MAX 1.0e9
#define STEPPER_STEP_RATE_MAX_HZ 50000.0 // one step in every second tick

// ---- Configuration ------------------------------------------------------------------------------

typedef struct {
    double arc_tolerance_mm;
    uint32_t blocks;          // slots of the queue, 1..STEPPER_BLOCKS_MAX
    uint8_t estop_gpio;       // active low, pulled up; PINS_NONE: none
    bool estop_keeps_enabled; // drivers stay on in an emergency stop
} stepper_init_t;

typedef struct {
    uint8_t step_gpio;
    uint8_t dir_gpio;    // high: positive direction, unless inverted
    uint8_t enable_gpio; // active low; PINS_NONE: none
    bool dir_invert;
    double steps_per_unit;   // steps/mm or steps/degree, 0.001..100000
    double max_velocity;     // mm/min or degrees/min, 0.001..1e7
    double max_acceleration; // mm/s^2 or degrees/s^2, 0.01..1e6
    double home_backoff_mm;
} stepper_axis_t;

// Makes everything ready and forgets all axes. Error: already initialised; a bad E-STOP pin.
err_t stepper_init(const stepper_init_t *config);

// Configures an axis, anew if it was configured. A refused call changes nothing.
// Errors: not initialised, moving or queued, pins taken.
err_t stepper_axis(axis_id_t axis, const stepper_axis_t *config);

// Greatest speed in units/min that the 50 kHz step rate allows on the axis.
double stepper_step_rate_limit(axis_id_t axis);

// Soft limits of X, Y or Z. Errors: axis not configured, min >= max.
err_t stepper_limits(axis_id_t axis, double min_mm, double max_mm);

// Junction deviation in mm (>= 0, 0 stops at every corner). Applies to moves queued from now on.
err_t stepper_junction(double deviation_mm);

// Whether moves queued from now on are jerk-limited (S-curve) or change their acceleration at once
// (trapezoid). INIT: trapezoid.
err_t stepper_scurve(bool on);

// Jerk limits of moves queued from now on: along the path, and of each axis (0: none of its own),
// in units/s^3, STEPPER_JERK_MIN..STEPPER_JERK_MAX. INIT: STEPPER_JERK_DEFAULT, none.
err_t stepper_jerk(double path, const double axis[AXIS_COUNT]);

// ---- Control ------------------------------------------------------------------------------------

typedef enum { STEPPER_IDLE_HOLD = 0, STEPPER_IDLE_DISABLE = 1 } stepper_idle_t;

// Arms: turns the drivers on and executes what is queued now and later. `idle` says what the
// drivers do when the queue has drained. Error: E-STOP asserted.
err_t stepper_run(stepper_idle_t idle);

// Drops the queue. Error: motion is under way.
err_t stepper_clear(void);

// Controlled stop: brakes along the path within the acceleration limits, drops the rest of the
// queue; the position stays exact. Returns at once; until standstill new moves are refused. At rest
// it only drops what waits for RUN.
void stepper_stop(void);

// Feed hold: brakes along the path within the acceleration limits and waits, in a dwell as well;
// the queue stays. `hold` false goes on from there. Stops end a hold.
err_t stepper_hold(bool hold);

#define STEPPER_OVERRIDE_MIN 10
#define STEPPER_OVERRIDE_MAX 200
#define STEPPER_OVERRIDE_RAPID_MAX 100
// Overrides in percent of the programmed feed and of the rapid speed, at once and for all that is
// queued. The axes' limits stay. INIT sets 100.
err_t stepper_override(int feed_percent, int rapid_percent);

// Emergency stop: no further step, spindle and coolant off, drivers off (unless INIT keeps them),
// queue dropped, disarmed. After a stop from speed the position counts as unknown.
err_t stepper_estop(void);

// Controlled stop, then gives all pins back. Waits for standstill.
err_t stepper_close(void);

// Says that the machine stands at `position` of `axis` / at zero of all axes. Position is known
// then. Refused while anything moves or is queued.
err_t stepper_set_position(axis_id_t axis, double position);
err_t stepper_set_home(void);

// ---- The queue ----------------------------------------------------------------------------------
// Each call puts one entry behind all before it, or fails and changes nothing.
// Errors of all: not initialised, queue full, stopping.

// What happens where a move begins, coming from the one before it.
typedef enum {
    STEPPER_CORNER_CONTINUOUS, // passes the corner itself, as fast as the junction deviation allows
    STEPPER_CORNER_EXACT,      // passes tangential joints, stops at every real corner
    STEPPER_CORNER_STOP,       // always stops
    STEPPER_CORNER_BLEND       // between lines: rounds the corner off within `blend_mm`
} stepper_corner_t;

typedef struct {
    double target[AXIS_COUNT]; // machine coordinates; axes that should not move: stepper_target()
    double feed; // units/min along X, Y, Z (A alone: degrees/min), 0.001..1e9; not if rapid
    bool rapid;  // as fast as the axes allow
    stepper_corner_t corner;
    double blend_mm; // > 0, with STEPPER_CORNER_BLEND
    // From the beginning of this move on the spindle has this speed, without a stop. No effect
    // while it is off or has no PWM. Otherwise the speed stays as it is.
    bool sets_spindle;
    double spindle_rpm;
} stepper_move_t;

// A straight line. Further errors: position unknown, an axis that should move is not configured,
// beyond the soft limits or what an int32 of steps can hold.
err_t stepper_move(const stepper_move_t *move);

// An arc in the plane of two axes; the other axes go along in proportion to the angle (helix). The
// end point is move.target. If the radius there is a little different from that at the start, as it
// is with rounded coordinates, it changes evenly along the arc.
typedef struct {
    stepper_move_t move;
    axis_id_t plane[2]; // counter-clockwise is from the first to the second axis: X Y, Z X or Y Z
    double centre[2];   // mm from the start, along these axes
    bool clockwise;
    // The arc passes its end point turns - 1 times before it ends there; if it ends where it
    // started, it is this many full circles. 1..STEPPER_ARC_TURNS_MAX.
    uint32_t turns;
} stepper_arc_t;

#define STEPPER_ARC_TURNS_MAX 100u
// Coordinates of an arc that were rounded to 0.01 mm can be this far off its circle.
#define STEPPER_ARC_ROUNDING_MM 0.0283

// Errors: as stepper_move(), for all of the arc's way; no radius, radius too large, and an end
// point that is off the circle by more than STEPPER_ARC_ROUNDING_MM and a thousandth of the radius,
// or by 100 times that.
err_t stepper_arc(const stepper_arc_t *arc);

// Waits at standstill. 0..STEPPER_DWELL_MAX_MS.
#define STEPPER_DWELL_MAX_MS 86400000.0
err_t stepper_dwell(double milliseconds);

// Where the last queued move ends; where the machine stands if none is queued.
void stepper_target(double target[AXIS_COUNT]);

// ---- Jogging ------------------------------------------------------------------------------------

// Moves one axis by hand: by `distance` units from where it stands, or without end for INFINITY and
// -INFINITY, at `feed` units/min (0: as fast as the axis allows). A further call while a jog is
// under way gives it a new target from the present position, without a stop if the way to it allows
// that. Brakes before the soft limits when the position is known. Needs no known position. Errors:
// not armed, a job is running or queued, axis not configured, feed not positive.
err_t stepper_jog(axis_id_t axis, double distance, double feed);

// Brakes a jog to a standstill; nothing else is touched.
err_t stepper_jog_stop(void);

// ---- Reports ------------------------------------------------------------------------------------

typedef struct {
    bool initialized, armed, moving, stopping, holding, jogging, position_known;
    stepper_idle_t idle;
    uint32_t blocks, blocks_free;
    uint32_t executed; // queue entries carried out since INIT
    uint32_t
        underruns; // times the tick ran dry at speed since INIT; anything but 0 is a fault of ours
    int feed_override, rapid_override; // percent
    double junction_deviation_mm, arc_tolerance_mm;
    bool scurve;
    double jerk, axis_jerk[AXIS_COUNT]; // units/s^3; 0: the axis has no limit of its own
    uint8_t estop_gpio;
    bool estop_keeps_enabled;
} stepper_status_t;

void stepper_status(stepper_status_t *status);

bool stepper_axis_configured(axis_id_t axis);
// The configuration and the soft limits; false if there are none.
bool stepper_axis_config(axis_id_t axis, stepper_axis_t *config);
bool stepper_axis_limits(axis_id_t axis, double *min_mm, double *max_mm);

// Where the motor is now, to the step; in steps and in units.
int32_t stepper_position_steps(axis_id_t axis);
double stepper_position(axis_id_t axis);

// Speed along the path now, units/min; 2 ms ahead of the motors.
double stepper_speed(void);

// -1 not initialised, 1 working on the queue, 0 idle.
int stepper_active(void);

// Free queue slots; 0 before INIT.
uint32_t stepper_blocks_free(void);

#define STEPPER_STATUS_ESTOP (1u << 6)
#define STEPPER_STATUS_POSITION_KNOWN (1u << 7)
// Live inputs and state: the bits of PEEK(STEPPER STATUS). Bits 0 to 5: limit switches, in the
// order of stepper_switch_t.
uint32_t stepper_status_bits(void);

#endif
