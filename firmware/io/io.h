// The pins of a BASIC program: what each of them is used for, its value, pulses, PWM, counters and
// changes. Every function takes a GPIO number that need not be valid. A refused call changes
// nothing. The face of firmware/io. Context: main loop.
#ifndef IO_H
#define IO_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"
#include "hal/hal.h"
#include "hal/hal_io.h"

// ---- What a pin is used for ---------------------------------------------------------------------
// Errors of all: no such pin, or it belongs to another part of the firmware (the message names it).
// A pin that belongs to the program already changes its use.

err_t io_set_off(unsigned gpio); // no error if it was not in use
err_t io_set_input(unsigned gpio, hal_pull_t pull);
err_t io_set_output(unsigned gpio);

// A voltage, or the converter's count 0..HAL_ANALOG_MAX. Error: not an analog pin.
err_t io_set_voltage(unsigned gpio);
err_t io_set_raw(unsigned gpio);

// Hz, counted over `gate_ms`; ms of one period, mean of `periods`; edges. Error: all counters in
// use.
err_t io_set_frequency(unsigned gpio, uint32_t gate_ms);
err_t io_set_period(unsigned gpio, uint32_t periods);
err_t io_set_counter(unsigned gpio, hal_edge_t edges, hal_pull_t pull);

// An input whose edges io_changed() tells.
err_t io_set_interrupt(unsigned gpio, hal_edge_t edges, hal_pull_t pull);

// An output of a PWM slice, low until io_pwm(). `output`: the slice * 2, + 1 for B, or IO_PWM_ANY.
// Errors: the pin is another output; another pin has it.
#define IO_PWM_ANY 0xFFu
err_t io_set_pwm(unsigned gpio, unsigned output);

// All pins of the program back to what they are after reset.
void io_reset(void);

// ---- Values -------------------------------------------------------------------------------------

typedef struct {
    bool is_whole;
    int64_t whole;
    double number;
} io_value_t;

// What the pin's use makes of it; a pin in use by another part of the firmware has its level.
// Error: not in use.
err_t io_read(unsigned gpio, io_value_t *value);

// Sets an output, or what a counter has counted. Error: neither of these.
err_t io_write(unsigned gpio, int64_t value);

// Several pins at once, as masks. Errors: as above, for the first pin that is wrong.
err_t io_read_port(uint32_t pins, uint32_t *levels);
err_t io_write_port(uint32_t pins, uint32_t levels);

// Degrees Celsius of the chip.
double io_temperature(void);

// The voltage of full scale.
#define IO_REFERENCE_VOLTS 3.3
void io_set_reference(double volts);

// ---- Pulses -------------------------------------------------------------------------------------

#define IO_PULSES 8
#define IO_PULSE_WAIT_MS 3.0 // shorter pulses are over when the call returns
#define IO_PULSE_MAX_MS 86400000.0

// Inverts an output for a time; again on the same pin: the time starts anew, and 0 ends it. Errors:
// not an output; IO_PULSES under way.
err_t io_pulse(unsigned gpio, double ms);

// ---- PWM ----------------------------------------------------------------------------------------

#define IO_SERVO_MIN (-20.0)
#define IO_SERVO_MAX 120.0

typedef struct {
    double frequency_hz;
    bool given[2];     // outputs A and B; what is not given stays
    double percent[2]; // high part of the period; negative: inverted
    bool phase_correct;
    bool defer; // set up only; io_pwm_sync() starts it
} io_pwm_t;

// Errors: frequency out of reach; an output has no pin.
err_t io_pwm(unsigned slice, const io_pwm_t *pwm);

// 50 pulses a second of 1 ms (0 %) to 2 ms (100 %).
err_t io_servo(unsigned slice, const bool given[2], const double percent[2]);

// Starts slices of the mask together, each at `percent` of its period. Error: one is not set up.
err_t io_pwm_sync(uint32_t slices, const double percent[HAL_PWM_SLICES]);

// Outputs low; the pins stay the slice's. Error: the slice is not the program's.
err_t io_pwm_off(unsigned slice);

// ---- Changes ------------------------------------------------------------------------------------

// Pins of io_set_interrupt() that had an edge since the last call. Costs next to nothing if there
// are none of those; for the background hook.
uint32_t io_changed(void);

#endif
