// Sine, cosine and angles that are the same to the bit on every machine. Inside stepper/ only.
// Context: any; trig_sin_cos() is integers only.
#ifndef STEPPER_TRIG_H
#define STEPPER_TRIG_H

#include <stdint.h>

#define TRIG_ONE ((int32_t)1 << 30)
#define TRIG_TURN 4294967296.0 // angles count in 2^-32 of a turn and wrap

typedef struct {
    int32_t cos, sin; // of TRIG_ONE, within 2^-29.6
} trig_t;

trig_t trig_sin_cos(uint32_t angle);

// The angle of the vector (x, y), which has some length, in turns: -0.5..0.5, counter-clockwise
// from x. Error below 4e-10; small angles keep their relative precision.
double trig_angle(double x, double y);

#endif
