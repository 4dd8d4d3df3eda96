// Instructions whose flags emulators get wrong, against results computed in C from the
// architecture's definitions. Context: main.
#include <stdio.h>

#include "pico/stdlib.h"

#include "check.h"

static const uint32_t values[] = {
    0,   1,          2,          31,         32,         33,         64,         255,
    256, 0x7ffffffe, 0x7fffffff, 0x80000000, 0x80000001, 0xfffffffe, 0xffffffff, 0x12345678};

typedef struct {
    uint32_t result;
    uint32_t flags; // NZCV in bits 31..28
} outcome_t;

#define RUN(name, instruction)                                                                     \
    static outcome_t name(uint32_t a, uint32_t b, uint32_t carry) {                                \
        outcome_t out;                                                                             \
        __asm volatile("lsrs %[c], %[c], #1\n" instruction " %[a], %[a], %[b]\n"                   \
                       "mrs %[f], apsr\n"                                                          \
                       : [a] "+l"(a), [f] "=l"(out.flags), [c] "+l"(carry)                         \
                       : [b] "l"(b)                                                                \
                       : "cc");                                                                    \
        out.result = a;                                                                            \
        out.flags &= 0xf0000000;                                                                   \
        return out;                                                                                \
    }

RUN(run_adcs, "adcs")
RUN(run_sbcs, "sbcs")
RUN(run_lsls, "lsls")
RUN(run_lsrs, "lsrs")
RUN(run_asrs, "asrs")
RUN(run_rors, "rors")

static uint32_t flags_of(uint32_t result, uint32_t carry, uint32_t overflow) {
    return (result & 0x80000000) | (result == 0) << 30 | carry << 29 | overflow << 28;
}

static outcome_t want_add(uint32_t a, uint32_t b, uint32_t carry) {
    uint64_t sum = (uint64_t)a + b + carry;
    int64_t signed_sum = (int64_t)(int32_t)a + (int32_t)b + carry;
    uint32_t result = (uint32_t)sum;
    return (outcome_t){result,
                       flags_of(result, (uint32_t)(sum >> 32), signed_sum != (int32_t)result)};
}

static outcome_t want_subtract(uint32_t a, uint32_t b, uint32_t carry) {
    return want_add(a, ~b, carry);
}

// One bit at a time, so that nothing depends on how C shifts by 32 and more.
static outcome_t want_shift(uint32_t a, uint32_t b, uint32_t carry, char kind) {
    for (uint32_t n = b & 255; n > 0; n--) {
        if (kind == 'l') {
            carry = a >> 31;
            a <<= 1;
        } else {
            carry = a & 1;
            uint32_t in = kind == 'a' ? a & 0x80000000 : kind == 'r' ? carry << 31 : 0;
            a = a >> 1 | in;
        }
    }
    return (outcome_t){a, flags_of(a, carry, 0)};
}

static outcome_t want_left(uint32_t a, uint32_t b, uint32_t carry) {
    return want_shift(a, b, carry, 'l');
}

static outcome_t want_right(uint32_t a, uint32_t b, uint32_t carry) {
    return want_shift(a, b, carry, 'u');
}

static outcome_t want_arithmetic(uint32_t a, uint32_t b, uint32_t carry) {
    return want_shift(a, b, carry, 'a');
}

static outcome_t want_rotate(uint32_t a, uint32_t b, uint32_t carry) {
    return want_shift(a, b, carry, 'r');
}

static const struct {
    const char *name;
    outcome_t (*run)(uint32_t a, uint32_t b, uint32_t carry);
    outcome_t (*want)(uint32_t a, uint32_t b, uint32_t carry);
    uint32_t flags; // those the instruction sets
} instructions[] = {
    {"adcs", run_adcs, want_add, 0xf0000000},        {"sbcs", run_sbcs, want_subtract, 0xf0000000},
    {"lsls", run_lsls, want_left, 0xe0000000},       {"lsrs", run_lsrs, want_right, 0xe0000000},
    {"asrs", run_asrs, want_arithmetic, 0xe0000000}, {"rors", run_rors, want_rotate, 0xe0000000},
};

void check_alu(int argument) {
    (void)argument;
    for (size_t i = 0; i < count_of(instructions); i++) {
        uint32_t wrong = 0, tried = 0;
        for (size_t a = 0; a < count_of(values); a++) {
            for (size_t b = 0; b < count_of(values); b++) {
                for (uint32_t carry = 0; carry < 2; carry++) {
                    outcome_t is = instructions[i].run(values[a], values[b], carry);
                    outcome_t want = instructions[i].want(values[a], values[b], carry);
                    tried++;
                    wrong += is.result != want.result ||
                             ((is.flags ^ want.flags) & instructions[i].flags) != 0;
                }
            }
        }
        printf("%s tried %lu wrong %lu\n", instructions[i].name, (unsigned long)tried,
               (unsigned long)wrong);
    }
}
