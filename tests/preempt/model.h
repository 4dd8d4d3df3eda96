// What the machine under test has been told, and what must come of it. Context: main loop.
#ifndef MODEL_H
#define MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "stepper/stepper.h"

#define MODEL_ESTOP_GPIO 15u
#define MODEL_LIMIT_GPIO 20u
#define MODEL_SPINDLE_GPIO 14u
#define MODEL_RPM_MAX 10000

typedef struct {
    uint64_t seed;
    bool straight; // all motion along one line, reversals too: acceleration can be judged
    bool calm;     // nothing that drops the queue: the end is known from the start
    bool curved;   // arcs and rounded corners: nobody knows the number of steps, nor that of blocks
    int direction[AXIS_COUNT];
    int place[AXIS_COUNT]; // hundredths of a unit, where the last move ends
    bool place_known;      // false: the machine was stopped between two hundredths
    int32_t steps[AXIS_COUNT];
    uint64_t pulses[AXIS_COUNT];
    uint32_t entries; // that must be executed
    bool held, armed, spindle;
    bool pwm; // the spindle has one
    int rpm;  // behind all that is queued, with PWM
    uint32_t blocks;
} model_t;

extern model_t model;
extern const stepper_axis_t model_axes[AXIS_COUNT];
extern uint64_t model_positions; // asked for and checked

// Ends the process with code 1 and a message.
_Noreturn void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
void check(bool right, const char *what);

void wait_us(unsigned us);

// Lets time pass until nothing moves; fails if that takes too long.
void wait_for_rest(void);
#define MODEL_WAIT_US 20000000u // virtual time in which everything must have come to an end

void check_status(const stepper_status_t *status);

// The position as the machine tells it was, at some moment of the question, where the motors were.
void check_position(void);

// At rest: all that was accepted is done.
void check_end(void);

// All motion since the session began kept the limits, as far as that can be judged.
void check_limits(void);

// After a stop, at rest: takes the machine's word, which is checked against its pins.
void follow_machine(void);

#endif
