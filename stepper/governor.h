// The governor: turns blocks into segments, some milliseconds ahead of the tick. Inside stepper/
// only.
#ifndef STEPPER_GOVERNOR_H
#define STEPPER_GOVERNOR_H

#include "stepper/stepper.h"

// Pins that the governor switches at their place in the motion. Masks may be 0.
typedef struct {
    uint32_t dir[AXIS_COUNT];
    uint32_t dir_inverted; // bit n: axis n has its direction pin low when it counts up
    uint32_t enable;       // active low
    // Inputs behind whose trip the drivers stay on.
    uint32_t keep_enabled;
} governor_pins_t;

// Everything below is for the main loop with the governor locked, if nothing else is said.

// At rest at `steps`, disarmed, nothing to do.
void governor_reset(const int32_t steps[AXIS_COUNT]);
void governor_set_pins(const governor_pins_t *pins); // at rest only: sets the direction pins
// Only the inputs whose trip leaves the drivers on: in motion as well.
void governor_keep_enabled(uint32_t pins);

// From now on blocks are executed and the drivers are on: always, or with `idle_off` only while
// there is something to do. Follow with hal_governor_request().
void governor_arm(bool idle_off);

// Blocks wait from now on; drivers keep their state. At rest only.
void governor_disarm(void);

// Says that the motors stand at `steps`. At rest only.
void governor_set_position(const int32_t steps[AXIS_COUNT]);

// Brake to a stop, then drop all blocks. Follow with hal_governor_request().
void governor_stop(void);

// Brake to a stop and keep all blocks, or go on. Follow with hal_governor_request().
void governor_hold(bool hold);

// Computes up to `ticks` ahead, more than usual, before the governor is held off for long.
// Contexts: also governor.
void governor_fill(uint32_t ticks);

// Ends all motion within this call, in this order: step pins low, spindle and coolant off, drivers
// off unless they are to stay on, queue dropped, disarmed. True if a motor was in motion: it may
// have slipped. Contexts: also governor.
bool governor_emergency_stop(bool keep_enabled);

// What the tick's inputs have done since the last call: the pins that stopped the machine, 0 if
// none did, and whether a motor was in motion then.
typedef struct {
    uint32_t pins;
    bool moved;
} governor_trip_t;
governor_trip_t governor_take_trip(void);

// Where the motors are now.
void governor_position(int32_t steps[AXIS_COUNT]);

// The speed at the end of what the tick has been given, units/s, and the way from there to the end
// of the front block. 0 at rest.
void governor_whereabouts(float *speed, float *left);

// The following may be read in any context, unlocked.
bool governor_armed(void);
bool governor_stopping(void);
bool governor_holding(void);
bool governor_paused(void);       // at a block that holds, and the motors stand
uint32_t governor_pauses(void);   // times it came to such a block since governor_reset()
float governor_speed(void);       // along the path, units/s
bool governor_working(void);      // segments are executed, or blocks wait and are allowed to start
uint32_t governor_executed(void); // blocks since governor_reset()
uint32_t governor_drops(void);    // times the queue was dropped by a stop: the planner must follow
// Grows with each queue entry that is carried out, each pause that is reached, and when the queue
// is dropped. Asked often.
uint32_t governor_ends(void);
bool governor_tripped(void); // governor_take_trip() has something to tell

#endif
