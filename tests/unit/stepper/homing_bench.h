// The bench's machine with limit switches on its axes, for tests of homing and probing.
#ifndef HOMING_BENCH_H
#define HOMING_BENCH_H

#include "bench.h"
#include "stepper/stepper_homing.h"
#include "stepper/stepper_safety.h"

#define PROBE_GPIO 21u

// As they stand in homing_bench.switches; the bits of stepper_switch_t are others.
enum { SWITCH_X_MIN, SWITCH_X_MAX, SWITCH_Y_MIN, SWITCH_Z_MAX, SWITCH_PROBE, SWITCH_COUNT };

// X_MIN is closed at 0 and below, X_MAX from 20000 on, Y_MIN at 0 and below, Z_MAX from 0 on, steps
// of the motors; the probe is a plate that X touches from 0 on downwards. All but the probe bounce.
extern simulate_switch_t homing_switches[SWITCH_COUNT];

// Every machine from now on has it.
void homing_bench_scurve(bool on);

// A fresh machine, armed, with the motors 4000 steps on the free side of the switches; all four
// axes' limits assigned. The position counts as unknown if `known` is false.
void homing_bench_start(bool known);

// The motor stands at `steps` now, and its switches are as they are there.
void homing_bench_put(axis_id_t axis, int64_t steps);

// Lets time pass until no cycle is under way, as the main loop would. Returns how it ended.
err_t homing_bench_finish(double limit_s);

// The same until homing is in this phase of this axis, and so many microseconds longer. Fails the
// test if that does not come.
void homing_bench_reach(axis_id_t axis, const char *phase, unsigned more_us);

#endif
