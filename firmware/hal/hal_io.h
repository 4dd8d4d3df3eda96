// The second half of the seam to the hardware: what the pins of a BASIC program need beyond levels.
// Analog inputs, PWM, counters, news of changed pins and one alarm; the rules of hal.h apply.
//
// One more context: the alarm, an interrupt below the tick and above the governor.
#ifndef HAL_HAL_IO_H
#define HAL_HAL_IO_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/pins.h"

typedef enum { HAL_EDGE_RISING = 1, HAL_EDGE_FALLING = 2, HAL_EDGE_BOTH = 3 } hal_edge_t;

// Cycles a second of the clock that PWM slices divide.
uint32_t hal_clock_hz(void);

// ---- Analog inputs ------------------------------------------------------------------------------

#define HAL_ANALOG_FIRST_GPIO 26u // this pin is channel 0
#define HAL_ANALOG_LAST_GPIO 28u
#define HAL_ANALOG_TEMPERATURE 4u // channel of the chip's own sensor
#define HAL_ANALOG_MAX 4095u      // full scale

// Makes the pin an analog input, without pull and without its digital input.
void hal_pin_analog(unsigned gpio);

// One conversion, 2 us.
uint32_t hal_analog_read(unsigned channel);

// ---- PWM ----------------------------------------------------------------------------------------
// Each slice has one counter and two outputs, A and B. Even pins are A, odd ones B; the slice is
// that of HAL_PWM_SLICE.

#define HAL_PWM_SLICES 8u
#define HAL_PWM_SLICE(gpio) ((gpio) / 2u % HAL_PWM_SLICES)
#define HAL_PWM_CHANNEL(gpio) ((gpio) % 2u) // 0: A, 1: B

typedef struct {
    uint16_t divider_16ths; // of the clock, 16 to 4095
    uint16_t top;           // the counter runs from 0 to this; at most 65534
    uint16_t level[2];      // the output is high while the counter is below; top + 1: always
    bool inverted[2];
    bool
        phase_correct; // the counter runs up and down: half the frequency, pulses around one centre
} hal_pwm_t;

// Gives the pin to its slice. Also governor, for a pin that was an output before.
void hal_pin_pwm(unsigned gpio);

// Settings of a slice; while it runs, top and levels follow at the end of the period.
void hal_pwm_set(unsigned slice, const hal_pwm_t *pwm);

// Starts the slices of a mask together, each at its own count; stops one, at count 0. Contexts:
// main, governor.
void hal_pwm_start(uint32_t slices, const uint16_t counts[HAL_PWM_SLICES]);
void hal_pwm_stop(unsigned slice);

// ---- Counters -----------------------------------------------------------------------------------
// They follow inputs of several MHz in hardware: no interrupt, no load. The pin must be an input.

#define HAL_COUNTERS 4u

// Counts the edges of a pin, from 0.
void hal_counter_start(unsigned counter, unsigned gpio, hal_edge_t edges);

// Edges so far, modulo 2^32. Context: main, alarm; in main with the alarm locked.
uint32_t hal_counter_read(unsigned counter);

// Measures how long `periods` periods of a pin last, again and again.
void hal_period_start(unsigned counter, unsigned gpio, uint32_t periods);

// The last measurement, in seconds for all the periods; 0 if none is complete yet.
double hal_period_read(unsigned counter);

void hal_counter_stop(unsigned counter); // either kind

// ---- Changed pins -------------------------------------------------------------------------------

// From now on such edges of the pin are noticed, and end hal_idle(). The pin must be an input.
void hal_pin_watch(unsigned gpio, hal_edge_t edges);
void hal_pin_unwatch(unsigned gpio);

// Watched pins that had an edge since the last call. However many edges a pin has, they load the
// board with at most one interrupt between two calls.
uint32_t hal_pins_changed(void);

// ---- The alarm, short waits ---------------------------------------------------------------------

typedef void (*hal_alarm_t)(void);

// Calls `handler` once, as soon as it is `at_us`; replaces what was set before. UINT64_MAX: never.
// Context: main with the alarm locked, and the handler itself.
void hal_alarm_set(uint64_t at_us, hal_alarm_t handler);

// Holds the handler off, for the main loop's short critical sections; does not nest.
void hal_alarm_lock(void);
void hal_alarm_unlock(void);

// Waits without doing anything else. For a few milliseconds at most.
void hal_wait_us(uint32_t us);

#endif
