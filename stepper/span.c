// The least acceleration and jerk of some blocks in a row, in three bytes. Contexts: main loop, governor.
#include "stepper/span.h"

#include <string.h>

#define JERK_CODE_BASE ((127u - 20u) << 2) // of 2^-20

static uint32_t float_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_from_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

span_t span_of(float acceleration, float limit) {
    uint32_t jerk = float_bits(limit) >> 21;
    if (jerk == 0) {
        jerk = UINT8_MAX; // not limited
    } else {
        jerk = jerk > JERK_CODE_BASE ? jerk - JERK_CODE_BASE : 0;
    }
    return (span_t){
        .acceleration = (uint16_t)(float_bits(acceleration) >> 16),
        .jerk = (uint8_t)(jerk < UINT8_MAX ? jerk : UINT8_MAX),
    };
}

float span_acceleration(span_t span) {
    return float_from_bits((uint32_t)span.acceleration << 16);
}

float span_jerk(span_t span) {
    return float_from_bits((span.jerk + JERK_CODE_BASE) << 21);
}

span_t span_least(span_t a, span_t b) {
    return (span_t){
        .acceleration = a.acceleration < b.acceleration ? a.acceleration : b.acceleration,
        .jerk = a.jerk < b.jerk ? a.jerk : b.jerk,
    };
}
