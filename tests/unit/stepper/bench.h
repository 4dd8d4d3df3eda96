// A machine on the host port for tests of motion: four axes, each with a simulated motor that
// counts the edges of its pins, and a watcher that notes the shortest times between edges.
#ifndef BENCH_H
#define BENCH_H

#include "simulate.h"
#include "stepper/stepper.h"
#include "stepper/stepper_outputs.h"

#define BENCH_SPINDLE_GPIO 14u
#define BENCH_ESTOP_GPIO 15u

typedef struct {
    simulate_axis_t motors[AXIS_COUNT];
    uint64_t min_step_gap_ns;  // between two steps of one axis
    uint64_t min_dir_setup_ns; // from a direction edge to the next step of the axis
    uint64_t min_dir_hold_ns;  // from a step to the next direction edge of the axis
    uint64_t last_step_ns;     // of any axis
} bench_t;

extern bench_t bench;

// The axes of bench_start(), and the pins of every bench.
extern const stepper_axis_t bench_axes[AXIS_COUNT];

// A fresh machine at home, armed: X, Y 80 steps/mm 6000 mm/min 500 mm/s^2; Z 400, 1200, 200; A 10,
// 36000, 2000.
void bench_start(void);

// The same, all axes with this configuration (pins are filled in) and a queue of `blocks`.
void bench_start_with(const stepper_axis_t *config, uint32_t blocks, bool estop_keeps_enabled);

// A spindle that is switched on and off, without a direction pin.
err_t bench_spindle(uint8_t gpio, bool invert);

// Closes the machine.
void bench_end(void);

// A straight move of X, Y, Z, A; waits for room in the queue. `feed` 0: rapid.
void bench_move(double x, double y, double z, double a, double feed);

// Lets time pass until nothing moves; fails if that takes more than `limit_s` of virtual time.
// Returns the time it took in seconds.
double bench_finish(double limit_s);

// Lets this much time pass.
void bench_wait_us(uint64_t us);

// Motors, counted at the pins, stand where the machine says, to the step.
void bench_check_positions(void);

#endif
