// The least acceleration and jerk of some blocks in a row, in three bytes. Inside stepper/ only.
// All of it is inline: the planner does this for each block while the governor waits. Contexts:
// main loop, governor.
#ifndef STEPPER_SPAN_H
#define STEPPER_SPAN_H

#include <stdint.h>
#include <string.h>

// Rounded down: the upper half of a float, and its exponent with two more bits. Codes compare like
// what they stand for.
typedef struct {
    uint16_t acceleration;
    uint8_t jerk;
} span_t;

#define SPAN_JERK_BASE ((127u - 20u) << 2) // of 2^-20

static inline uint32_t span_float_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline float span_float_from_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// A jerk of 0 is none at all.
static inline span_t span_of(float acceleration, float limit) {
    uint32_t jerk = span_float_bits(limit) >> 21;
    if (jerk == 0) {
        jerk = UINT8_MAX; // not limited
    } else {
        jerk = jerk > SPAN_JERK_BASE ? jerk - SPAN_JERK_BASE : 0;
    }
    return (span_t){
        .acceleration = (uint16_t)(span_float_bits(acceleration) >> 16),
        .jerk = (uint8_t)(jerk < UINT8_MAX ? jerk : UINT8_MAX),
    };
}

// What a code stands for.
static inline float span_acceleration(span_t span) {
    return span_float_from_bits((uint32_t)span.acceleration << 16);
}

static inline float span_jerk(span_t span) {
    return span_float_from_bits((span.jerk + SPAN_JERK_BASE) << 21);
}

static inline span_t span_least(span_t a, span_t b) {
    return (span_t){
        .acceleration = a.acceleration < b.acceleration ? a.acceleration : b.acceleration,
        .jerk = a.jerk < b.jerk ? a.jerk : b.jerk,
    };
}

#endif
