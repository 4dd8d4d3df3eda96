// Inputs that stop the machine, the alarm they leave, and what happened without being asked for. A
// further face of stepper/, beside stepper.h. Context: main loop.
//
// The E-STOP and limit inputs are watched while the machine is armed. If one of them trips, no step
// follows after the next tick, and everything else is done at once and in this order: spindle and
// coolant off, drivers off (unless they are to stay on), queue dropped, disarmed. If a motor was in
// motion the position counts as unknown; otherwise it is what it was. An alarm is left, which
// refuses RUN, moves and jogs until somebody says that the machine has been looked at.
#ifndef STEPPER_SAFETY_H
#define STEPPER_SAFETY_H

#include "stepper/stepper.h"

// ---- Limit switches -----------------------------------------------------------------------------

// In the order of the bits of PEEK(STEPPER STATUS). Those of axis n: 2 * n for min, 2 * n + 1 for
// max.
typedef enum {
    STEPPER_X_MIN,
    STEPPER_X_MAX,
    STEPPER_Y_MIN,
    STEPPER_Y_MAX,
    STEPPER_Z_MIN,
    STEPPER_Z_MAX,
    STEPPER_SWITCHES
} stepper_switch_t;

#define STEPPER_FILTER_MAX 100 // samples, 10 us apart
#define STEPPER_FILTER_LIMITS 3
#define STEPPER_FILTER_ESTOP 1

typedef struct {
    uint8_t gpio[STEPPER_SWITCHES]; // PINS_NONE: none. Min and max of an axis may share one
    uint32_t active_high;           // bit n: switch n; pulled down then, otherwise pulled up
} stepper_hwlimits_t;

// Sets all switches anew; a refused call changes nothing. A switch that is pressed while the
// machine is armed is overridden (stepper_overridden). Errors: not initialised, moving or queued,
// pins taken, polarities of a shared pin differ.
err_t stepper_hwlimits(const stepper_hwlimits_t *config);

// How many samples in a row an input has to be active to trip; 1..STEPPER_FILTER_MAX. INIT sets the
// values above. At any time.
err_t stepper_filter(uint32_t limit_samples, uint32_t estop_samples);

// Whether the drivers stay on when a limit switch trips, so that an axis does not drop. INIT: off.
err_t stepper_limit_keep(bool keep_enabled);

typedef struct {
    stepper_hwlimits_t switches;
    uint32_t limit_samples, estop_samples;
    bool keep_enabled;
} stepper_safety_t;
void stepper_safety(stepper_safety_t *config);

// "X_MIN".
const char *stepper_switch_name(stepper_switch_t which);

// "X_MIN, Y_MAX" for the switches (bit n: switch n). Returns `text`.
#define STEPPER_SWITCH_NAMES_SIZE 48
const char *stepper_switch_names(char text[STEPPER_SWITCH_NAMES_SIZE], uint32_t switches);

// Switches that are pressed now; bit n: switch n.
uint32_t stepper_pressed(void);

// Switches that do not trip: pressed when the machine was armed and not released since. Lines and
// arcs are refused meanwhile; homing is not, nor jogging away from the switch.
uint32_t stepper_overridden(void);

// ---- Alarm --------------------------------------------------------------------------------------

typedef enum { STEPPER_ALARM_NONE, STEPPER_ALARM_LIMIT, STEPPER_ALARM_ESTOP } stepper_alarm_t;

// What is to be acknowledged: by homing, by saying where the machine stands (stepper_set_home(),
// stepper_set_position()), or by stepper_recover(). None of them is possible while E-STOP is
// pressed.
stepper_alarm_t stepper_alarm(void);

// What the last trip was: the switches (bit n: switch n), whether E-STOP was among it, and whether
// the position was lost.
typedef struct {
    uint32_t switches;
    bool estop, position_lost;
} stepper_trip_t;
void stepper_last_trip(stepper_trip_t *trip);

// Acknowledges the alarm, whatever it is: stops what moves (by an emergency stop that leaves the
// drivers as they are), spindle and coolant off, queue dropped, disarmed. The position stays what
// it is, unless a motor was in motion. Errors: not initialised, E-STOP pressed.
err_t stepper_recover(void);

// ---- Events -------------------------------------------------------------------------------------

// What happened. The numbers are those of PEEK(STEPPER EVENT).
typedef enum {
    STEPPER_EVENT_NONE,
    STEPPER_EVENT_ESTOP,         // the E-STOP input has stopped the machine
    STEPPER_EVENT_LIMIT,         // a limit switch has
    STEPPER_EVENT_IDLE,          // the queue has been carried out or dropped, nothing moves
    STEPPER_EVENT_HOMED,         // homing has ended well
    STEPPER_EVENT_HOMING_FAILED, //
    STEPPER_EVENT_PROBED,        // probing has ended, with or without contact
    STEPPER_EVENT_JOB_DONE,      // a G-code file has been carried out, or has failed
    STEPPER_EVENT_PAUSED,        // the queue waits at M0, M1 or M6
    STEPPER_EVENTS
} stepper_event_t;

// It has happened. Several of a kind before it is taken are one.
void stepper_raise_event(stepper_event_t event);

// Takes one; NONE when there is no more. Call it often.
stepper_event_t stepper_next_event(void);

// Counts how often the queue was dropped: by a stop, E-STOP, a limit switch or CLEAR. Whoever feeds
// it by and by ends that when the number changes.
uint32_t stepper_drops(void);

#endif
