// Functions of numbers, but for angles. Context: main loop.
#include <math.h>

#include "errors.h"
#include "functions.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)
#define UNUSED_COUNT() (void)count

static void set_checked(value_t *result, double number) {
    if (!value_is_finite(number)) {
        errors_fail(ERR_OVERFLOW);
    }
    value_set_number(result, number);
}

FUNCTION(abs) {
    UNUSED_COUNT();
    if (arguments->type == VALUE_INTEGER) {
        int64_t integer = arguments->integer;
        value_set_integer(result, integer < 0 ? (int64_t)(0 - (uint64_t)integer) : integer);
    } else {
        value_set_number(result, fabs(arguments->number));
    }
}

FUNCTION(sgn) {
    UNUSED_COUNT();
    value_set_integer(result, (arguments->number > 0) - (arguments->number < 0));
}

// INT, FIX and CINT: `rounding` is applied to a float; an integer is what it is.
static void to_integer(const value_t *argument, value_t *result, double (*rounding)(double)) {
    value_set_integer(result, argument->type == VALUE_INTEGER
                                  ? argument->integer
                                  : value_round(rounding(argument->number)));
}

FUNCTION(int) {
    UNUSED_COUNT();
    to_integer(arguments, result, floor);
}

FUNCTION(fix) {
    UNUSED_COUNT();
    to_integer(arguments, result, trunc);
}

FUNCTION(cint) {
    UNUSED_COUNT();
    to_integer(arguments, result, round);
}

FUNCTION(sqr) {
    UNUSED_COUNT();
    if (arguments->number < 0) {
        errors_fail(ERR_NEGATIVE_ARGUMENT);
    }
    value_set_number(result, sqrt(arguments->number));
}

static void check_logarithm(double number) {
    if (number < 0) {
        errors_fail(ERR_NEGATIVE_ARGUMENT);
    }
    if (number == 0.0) {
        errors_fail(ERR_DIVIDE_BY_ZERO);
    }
}

FUNCTION(log) {
    UNUSED_COUNT();
    check_logarithm(arguments->number);
    value_set_number(result, log(arguments->number));
}

FUNCTION(exp) {
    UNUSED_COUNT();
    set_checked(result, exp(arguments->number));
}

FUNCTION(max) {
    double best = arguments[0].number;
    for (unsigned i = 1; i < count; i++) {
        best = fmax(best, arguments[i].number);
    }
    value_set_number(result, best);
}

FUNCTION(min) {
    double best = arguments[0].number;
    for (unsigned i = 1; i < count; i++) {
        best = fmin(best, arguments[i].number);
    }
    value_set_number(result, best);
}

// xorshift64* (G. Marsaglia, S. Vigna); never 0.
static uint64_t random_state = 0x9E3779B97F4A7C15u;

void functions_seed(uint64_t seed) {
    random_state = (seed ^ 0x9E3779B97F4A7C15u) * 0xD1342543DE82EF95u;
    if (random_state == 0) {
        random_state = 1;
    }
}

FUNCTION(rnd) {
    UNUSED_COUNT();
    (void)arguments;
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    uint64_t bits = random_state * 0x2545F4914F6CDD1Du;
    value_set_number(result, (double)(bits >> 11) * 0x1p-53);
}

FUNCTION(math_log10) {
    UNUSED_COUNT();
    check_logarithm(arguments->number);
    value_set_number(result, log10(arguments->number));
}

FUNCTION(math_sinh) {
    UNUSED_COUNT();
    set_checked(result, sinh(arguments->number));
}

FUNCTION(math_cosh) {
    UNUSED_COUNT();
    set_checked(result, cosh(arguments->number));
}

FUNCTION(math_tanh) {
    UNUSED_COUNT();
    value_set_number(result, tanh(arguments->number));
}

FUNCTION(math_power) {
    UNUSED_COUNT();
    set_checked(result, pow(arguments[0].number, arguments[1].number));
}
