// The outputs that are switched in the queue: their pins, and how they are behind its end. Inside
// stepper/ only. Context: main loop, if nothing else is said.
#ifndef STEPPER_OUTPUTS_H
#define STEPPER_OUTPUTS_H

#include "stepper/planner.h"
#include "stepper/stepper_outputs.h"

enum { OUTPUTS_NOT_LIMITED, OUTPUTS_LIMITED, OUTPUTS_TOLD };

typedef struct {
    stepper_spindle_t spindle;
    stepper_coolant_t coolant;
    uint32_t counts;             // of a PWM period; 0: no PWM
    uint8_t limited;             // a speed above the greatest was asked for; OUTPUTS_...
    bool laser;                  // the spindle is one, with a beam that is off at standstill
    uint8_t turn;                // behind the newest entry
    uint16_t level;              // counts of the PWM period; of all moves that are queued now
    volatile uint8_t turn_now;   // as executed; governor
    volatile bool pwm_connected; // the pin shows the slice; governor
    // Of a laser; governor.
    bool lit;              // the beam may be on in what was written last
    bool dark;             // it is stopping, so no move lights the beam again
    bool dims;             // what is executed has a level that follows the speed
    uint16_t most;         // that level
    float level_per_speed; // in units/s
} outputs_t;

extern outputs_t outputs;

// Which level makes this speed; 0 without PWM.
uint16_t outputs_level(double rpm);

// No beam for what is queued from now on, as M5 has it. Nothing if there is no laser.
void outputs_forget_beam(void);

// Gives all their pins back. Nothing moves.
void outputs_take_away(void);

// The level of this coolant pin says on.
bool outputs_coolant_on(uint8_t gpio);

// After the queue was dropped: what is queued next follows what the outputs are now.
void outputs_follow(void);

// A block of switches is executed from now on. Context: governor.
void outputs_begin(const block_t *block);

// A move or a dwell is, or goes on after a hold. Context: governor.
void outputs_enter(const block_t *block);

// While outputs.dims: what is written next goes at this speed. Context: governor.
void outputs_follow_speed(float speed);

// There is a laser, and its beam may be on in what was written last; then what is written next has
// it off. Context: governor.
bool outputs_put_out(void);

// A controlled stop has begun: a laser's beam is off from now on, until that has ended. Contexts:
// governor, main with the governor locked.
void outputs_begin_stop(void);
void outputs_end_stop(void);

// Off at once; nothing is being executed any more. Contexts: governor, main with the governor
// locked.
void outputs_spindle_off(void);
void outputs_coolant_off(void);
void outputs_off(void); // all of them

#endif
