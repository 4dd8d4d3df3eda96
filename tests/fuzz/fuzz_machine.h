// What must hold for the machine whatever the input: checks against the pins, the queue and the
// targets.
#ifndef FUZZ_MACHINE_H
#define FUZZ_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

#include "stepper/stepper.h"

// What an input that is refused must leave as it is.
typedef struct {
    bool initialized;
    bool armed;
    bool position_known;
    // The target follows the motors at the end of a stop or a jog, and lines that wait for room or
    // a cycle go on filling the queue, whatever is typed.
    bool changing;
    uint32_t queued; // entries ever queued
    double target[AXIS_COUNT];
    double offset[AXIS_COUNT];
    bool configured[AXIS_COUNT];
    uint32_t driver_writes; // registers that the motor drivers have taken
    bool arming;            // homing may write to them as well, whatever is typed
} fuzz_machine_t;

// Starts watching the pins: step pulses at least two ticks apart, none in the tick in which the
// direction changed. Once for each process.
void fuzz_machine_watch(void);

void fuzz_machine_look(fuzz_machine_t *now);

// Fails if the queue, a target or an offset differs.
void fuzz_machine_check_unchanged(const fuzz_machine_t *before);

// Fails unless every configured axis has moved by exactly the pulses seen at its pins since the
// last fuzz_machine_rebase(), and the tick never ran dry at speed.
void fuzz_machine_check_pulses(void);

// The position was set, not moved to: from here on pulses count anew.
void fuzz_machine_rebase(void);

// Steps are being made, or time has to pass before they are; not a machine that is held at a
// standstill.
bool fuzz_machine_is_moving(void);

// Waits until motion has ended and checks that it ended exactly on the target. Stops it in a
// controlled way after `limit_s` of virtual time, and if that is not done after the same time
// again, by emergency stop. Returns true if motion came to its end by itself.
bool fuzz_machine_settle(double limit_s);

#endif
