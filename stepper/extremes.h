// The lesser and the greater of two numbers, neither of them NaN. Unlike fminf() no call, and the
// same on every machine. Inside stepper/ only. Any context.
#ifndef STEPPER_EXTREMES_H
#define STEPPER_EXTREMES_H

static inline float lesser(float a, float b) {
    return a < b ? a : b;
}

static inline float greater(float a, float b) {
    return a > b ? a : b;
}

#endif
