// A stepper motor between its driver and the carriage. Context: any (called where the edge is
// made).
//
// Places are in 1/256 of a full step. The field has a place of rest for the rotor every four full
// steps; `pole` is the one that the rotor is held by. Pulled from it, a rotor resists with
//
//     torque = full torque * sin(90 deg * lag in full steps)
//
// which is greatest at one full step and gone at two: there the next place of rest, four full steps
// behind, is as near, and the rotor slips to it. So a motor that is blocked swings with the field
// for two full steps, falls back, and comes to the obstacle again, at the end of which its place
// is wrong by a multiple of four full steps. A field that turns back takes the rotor along as soon
// as its place of rest lies on this side of the obstacle. The rotor has no mass: it is always where
// the torque of the field and the friction balance.
#ifndef SIMULATE_MOTOR_H
#define SIMULATE_MOTOR_H

#include <stdbool.h>
#include <stdint.h>

#define SIMULATE_MOTOR_FULL_STEP 256 // in units of a place
#define SIMULATE_MOTOR_PERIOD 1024   // from one place of rest to the next
#define SIMULATE_MOTOR_LAG_MAX 512   // beyond, the rotor slips
#define SIMULATE_MOTOR_NO_END INT64_MAX

// Fill in the first group; the rest starts at zero, but pole and rotor at the same place.
typedef struct {
    int64_t stop_low, stop_high; // obstacles; -SIMULATE_MOTOR_NO_END, SIMULATE_MOTOR_NO_END: none
    uint32_t load_ma;            // a current (rms) of which the torque just overcomes the friction

    int64_t pole, rotor;
    uint64_t slips;       // so far
    int64_t since_slip;   // way of the field since the last one
    uint32_t torque_1024; // the greatest since simulate_motor_take_torque(), 1024: full
} simulate_motor_t;

// A motor whose rotor stands at a place, without load and obstacles.
void simulate_motor_init(simulate_motor_t *motor, int64_t rotor);

// Turns the field by at most a full step, at a current (rms); 0: the rotor is free.
void simulate_motor_turn(simulate_motor_t *motor, int32_t way, uint32_t current_ma);

// The field jumps to the place of rest at `phase` (0 to 1023) that is nearest to the rotor, as when
// the power comes back.
void simulate_motor_jump(simulate_motor_t *motor, int64_t phase, uint32_t current_ma);

// The greatest torque since the last call, of 1024; all of it while the motor slips and until it
// has followed the field for four full steps again.
uint32_t simulate_motor_take_torque(simulate_motor_t *motor);

#endif
