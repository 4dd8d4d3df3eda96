// Cycles: what homing and probing have in common. One at a time is under way; at each standstill
// the next move of it is started, by stepper_background(). Inside stepper/ only. Context: main
// loop.
#ifndef STEPPER_CYCLE_H
#define STEPPER_CYCLE_H

#include "stepper/stepper_homing.h"

// Why a cycle failed; each has its text in cycle.c. The homing of an axis:
typedef enum {
    CYCLE_DONE,
    CYCLE_STOPPED,        // somebody asked for a stop
    CYCLE_TRIPPED,        // an emergency stop or a limit switch
    CYCLE_TOO_FAR,        // steps do not fit
    CYCLE_EITHER_END,     // it stands on a switch of which nobody knows at which end it is
    CYCLE_NEVER_CLOSED,   // the switch, within so many mm
    CYCLE_NEVER_OPENED,   // the same
    CYCLE_DRIVER,         // the hook has failed: the current error says why
    CYCLE_NO_CONTACT,     // the probe, before the target
    CYCLE_CONTACT_KEPT,   // the same, probing away
    CYCLE_CONTACT_BEFORE, // when probing was to begin
    CYCLE_NO_CONTACT_BEFORE
} cycle_end_t;

// Begins: `kind` is under way; what is queued is executed first, drivers stay on meanwhile.
void cycle_begin(stepper_cycle_t kind);

// Ends it. `who` (axes; 0: those that move now) and `mm` are part of the message of some ends.
void cycle_end(cycle_end_t why, uint32_t who, double mm);

// Someone wants motion to stop: the cycle ends at the standstill.
void cycle_stop(void);

// Ends a cycle whose machine has been stopped, as soon as it stands.
void cycle_follow(void);

// What was queued before the cycle has been executed: all that moves is its own.
bool cycle_moves(void);

// INIT and CLOSE: no cycle, and none before.
void cycle_forget(void);

// ---- Moves of a cycle; the machine is at rest ---------------------------------------------------

// What ends a move of a cycle early: one of `pins` has its level of `levels`. Motion is braked
// then, or ends at once if it is one of `halts`. Masks of pins. They are not looked at for the
// first `after_us`.
typedef struct {
    uint32_t pins, levels, halts;
    uint32_t after_us;
} cycle_until_t;

// A line to `target` steps, at `feed` units/min whatever the override says. `until` may be NULL.
void cycle_move(const int32_t target[AXIS_COUNT], double feed, const cycle_until_t *until);

// Behind such a move: the pins that ended it, and where the motors were then. 0: none did.
uint32_t cycle_moved(int32_t steps[AXIS_COUNT]);

// Stands still for a while, until contacts have stopped bouncing.
void cycle_settle(void);

#endif
