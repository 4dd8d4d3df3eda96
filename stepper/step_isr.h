// The tick: executes segments, at most one step of each axis in a tick, and samples inputs before
// each step. Inside stepper/ only.
//
// There are two kinds of inputs. One of those that trip stops the machine: no step from the sample
// on, the tick has stopped itself, the governor is called. One of those that latch leaves a note of
// where the motors were and calls the governor, which brakes; or, if that is wanted, there is no
// step from the sample on either, and the machine stands there, armed. A level counts when it was
// there for so many samples, 10 us apart, in a row.
#ifndef STEPPER_STEP_ISR_H
#define STEPPER_STEP_ISR_H

#include "stepper/segment.h"

// Inputs that stop the machine. Masks of pins.
typedef struct {
    uint32_t estop, limits;
    uint32_t levels;                       // bit of a pin set: high is the level that stops
    uint32_t estop_samples, limit_samples; // >= 1
    uint32_t immediate;                    // step_isr.c's: those of one sample
} step_isr_inputs_t;

// Starts afresh with an empty ring and no inputs. Context: main, while the tick is stopped.
void step_isr_setup(void);

// Watches these from now on, at any time: those that stay are watched without a gap. While there is
// something to watch, the tick goes on when there is nothing to execute; otherwise it stops by
// itself. Context: main with the governor locked.
void step_isr_watch(const step_isr_inputs_t *inputs);

// The step pin of each axis as a mask, 0 for none. Context: main, while nothing moves.
void step_isr_set_pins(const uint32_t masks[AXIS_COUNT]);

// Where the level of each segment goes. Context: main, while nothing moves.
void step_isr_set_pwm(hal_pwm_place_t place);

// No further step from now on: stops the tick, lowers the step pins. True if a motor was in motion.
// The position can still be asked for; then step_isr_abort(), which empties the ring as well.
// Contexts: main with the governor locked, governor.
bool step_isr_halt(void);
void step_isr_abort(void);

// Where the motors are; false if the ring is empty, then the end of the last segment holds.
// Contexts: main with the governor locked, governor.
bool step_isr_position(int32_t steps[AXIS_COUNT]);

// The inputs that have stopped the machine, and the tick with it; 0: none. Until step_isr_rearm().
// Any context.
uint32_t step_isr_tripped(void);
void step_isr_rearm(void);

// An input has stopped the tick, one that trips or one that latches. However often it is started,
// it makes no step until step_isr_abort(). Any context.
bool step_isr_stopped(void);

// There are inputs to watch. Any context.
bool step_isr_watches(void);

// ---- Latch --------------------------------------------------------------------------------------

#define STEP_ISR_LATCH_SAMPLES_MAX 16u

// Masks of pins.
typedef struct {
    uint32_t pins;
    uint32_t levels;  // bit of a pin set: high is what it waits for
    uint32_t halts;   // those of the pins that end motion without braking
    uint32_t samples; // 1..STEP_ISR_LATCH_SAMPLES_MAX
} step_isr_latch_t;

// From now on the first of the pins that has its level leaves a note; one that has it already does
// so at once. Motion is braked then, or halted, and the queue dropped, as by a controlled stop.
// Pins that also trip do trip: take them out first (step_isr_watch). Forgets an earlier note.
// Context: main with the governor locked.
void step_isr_latch_arm(const step_isr_latch_t *latch);

// No longer. Context: main with the governor locked.
void step_isr_latch_disarm(void);

// True once a pin has left its note: the pins, and where the motors were at the first of the
// samples, exactly. Until the latch is armed or disarmed. Context: main with the governor locked.
bool step_isr_latched(int32_t steps[AXIS_COUNT], uint32_t *pins);

// For the governor. A note waits to be made into a position; doing so, false if the machine stands
// and its position is to be told with step_isr_latch_stand(); how many of the free slots must not
// be written meanwhile, because the note may need them.
bool step_isr_latch_waits(void);
bool step_isr_latch_collect(void);
void step_isr_latch_stand(const int32_t steps[AXIS_COUNT]);
uint32_t step_isr_latch_reserve(void);

// Times the ring ran dry in the middle of a motion. Any context.
uint32_t step_isr_dry_count(void);

#endif
