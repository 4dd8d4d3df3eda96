// Floating point by the SDK's routines on pseudo-random operands. Prints operands and results as
// bits, for the host to compare with its own: host and board must round alike, or their step trains
// would differ. Context: main.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pico/stdlib.h"

#include "check.h"

static uint64_t state;

// xorshift64*: the same sequence in the test.
static uint64_t next_random(void) {
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return state * 0x2545F4914F6CDD1Dull;
}

static uint32_t bits_of_float(float f) {
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return bits;
}

static uint64_t bits_of_double(double d) {
    uint64_t bits;
    memcpy(&bits, &d, sizeof bits);
    return bits;
}

// Any sign and fraction, exponents of 2^-40 to 2^40: nothing leaves the normal numbers.
static float random_float(void) {
    uint64_t r = next_random();
    uint32_t bits = (uint32_t)(r & 0x807fffff) | (uint32_t)(127 - 40 + (r >> 32) % 81) << 23;
    float f;
    memcpy(&f, &bits, sizeof f);
    return f;
}

static double random_double(void) {
    uint64_t r = next_random();
    uint64_t exponent = 1023 - 200 + (next_random() >> 32) % 401;
    uint64_t bits = (r & 0x800fffffffffffffull) | exponent << 52;
    double d;
    memcpy(&d, &bits, sizeof d);
    return d;
}

// Every so often operands close together: cancellation is where rounding goes wrong.
static double near_double(double a) {
    uint64_t bits = bits_of_double(a) ^ (next_random() & 0xff);
    double d;
    memcpy(&d, &bits, sizeof d);
    return next_random() & 1 ? d : -d;
}

static float near_float(float a) {
    uint32_t bits = bits_of_float(a) ^ (uint32_t)(next_random() & 0xff);
    float f;
    memcpy(&f, &bits, sizeof f);
    return next_random() & 1 ? f : -f;
}

// FNV-1a over the results, so that 20,000 pairs do not have to cross the USB line one by one.
static uint64_t hash;

static void mix(uint64_t bits) {
    for (int i = 0; i < 8; i++) {
        hash = (hash ^ (bits >> (8 * i) & 0xff)) * 0x100000001b3ull;
    }
}

static void float_pair(bool show) {
    volatile float a = random_float();
    volatile float b = next_random() % 8 == 0 ? near_float(a) : random_float();
    float results[] = {a + b, a - b, a * b, a / b, sqrtf(fabsf(a))};
    for (size_t i = 0; i < count_of(results); i++) {
        mix(bits_of_float(results[i]));
    }
    if (show) {
        printf("f %08lx %08lx", (unsigned long)bits_of_float(a), (unsigned long)bits_of_float(b));
        for (size_t i = 0; i < count_of(results); i++) {
            printf(" %08lx", (unsigned long)bits_of_float(results[i]));
        }
        printf("\n");
    }
}

static void double_pair(bool show) {
    volatile double a = random_double();
    volatile double b = next_random() % 8 == 0 ? near_double(a) : random_double();
    double results[] = {a + b, a - b, a * b, a / b, sqrt(fabs(a))};
    for (size_t i = 0; i < count_of(results); i++) {
        mix(bits_of_double(results[i]));
    }
    if (show) {
        printf("d %016llx %016llx", bits_of_double(a), bits_of_double(b));
        for (size_t i = 0; i < count_of(results); i++) {
            printf(" %016llx", bits_of_double(results[i]));
        }
        printf("\n");
    }
}

// `count` pairs of each kind: a hash after every 64, or all results if `count` is negative (then
// -count pairs).
void check_float(int count) {
    bool show = count < 0;
    state = 0x9E3779B97F4A7C15ull;
    hash = 0xcbf29ce484222325ull;
    for (int i = 1; i <= (show ? -count : count); i++) {
        float_pair(show);
        double_pair(show);
        if (!show && i % 64 == 0) {
            printf("h %016llx\n", hash);
        }
    }
    printf("end %016llx\n", hash);
}
