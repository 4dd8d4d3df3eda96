// The machine's state and what it forbids, between the stepper_*.c files. Inside stepper/ only.
// Context: main loop.
#ifndef STEPPER_MACHINE_H
#define STEPPER_MACHINE_H

#include "stepper/stepper.h"

typedef struct {
    bool initialized;
    bool position_known;
    uint8_t known_axes; // mask: all while it is known; those that were homed since it was lost
    bool alarm;         // a safety input has stopped the machine, not yet acknowledged
    bool limit_active;  // the machine stands on a limit switch and may only leave it
    stepper_idle_t idle;
    stepper_init_t config;
    int feed_override, rapid_override; // percent
    uint32_t drops_seen;               // of governor_drops(), that the planner has followed
} machine_t;

extern machine_t machine;

// Where the motors are now.
void machine_motor_steps(int32_t steps[AXIS_COUNT]);

// The planner goes on from where the motors stand.
void machine_follow_motors(void);

// After a stop the queue is gone; what is queued next starts where the machine stands.
void machine_follow_stops(void);

// A stop is under way; the planner does not know yet where the machine will stand.
bool machine_stopping(void);

// Turns the drivers on and lets what is queued be executed.
void machine_arm(stepper_idle_t idle);

// There is motion, or the tick has something to do besides watching the E-STOP input.
bool machine_executing(void);

// If all that is left ends by itself within milliseconds, waits for it.
void machine_await_end(void);

bool machine_estop_asserted(void);

// Says that the motors stand at `steps`; the position is known then. At rest only.
void machine_stand_at(const int32_t steps[AXIS_COUNT]);

// The position of these axes is lost, and so that of the machine is not known.
#define MACHINE_ALL_AXES ((1u << AXIS_COUNT) - 1)
void machine_lose_position(uint32_t lost);

// Makes the pins of the configuration known to tick and governor. At rest only.
void machine_pass_pins_on(void);

// The same for what leaves the drivers on, in motion as well.
void machine_pass_keep_on(void);

// Makes the overrides count for what is queued; the moves of a cycle have none.
void machine_pass_override_on(void);

// Controlled stop, and waits until the machine stands.
void machine_stop_and_wait(void);

#endif
