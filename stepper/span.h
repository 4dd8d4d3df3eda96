// The least acceleration and jerk of some blocks in a row, in three bytes. Inside stepper/ only.
// Contexts: main loop, governor.
#ifndef STEPPER_SPAN_H
#define STEPPER_SPAN_H

#include <stdint.h>

// Rounded down: the upper half of a float, and its exponent with two more bits. Codes compare like what they
// stand for.
typedef struct {
    uint16_t acceleration;
    uint8_t jerk;
} span_t;

// A jerk of 0 is none at all.
span_t span_of(float acceleration, float jerk);
span_t span_least(span_t a, span_t b);

// What a code stands for.
float span_acceleration(span_t span);
float span_jerk(span_t span);

#endif
