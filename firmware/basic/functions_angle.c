// Functions of angles, in radians or, after OPTION ANGLE DEGREES, in degrees. Context: main loop.
#include <math.h>

#include "errors.h"
#include "functions.h"
#include "vm.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)
#define UNUSED_COUNT() (void)count

static const double pi = 3.14159265358979323846;

static void set_checked(value_t *result, double number) {
    if (!value_is_finite(number)) {
        errors_fail(ERR_OVERFLOW);
    }
    value_set_number(result, number);
}

// ---- From an angle ------------------------------------------------------------------------------

// The sine of an angle in degrees plus `quarters` right angles; exact where both are whole.
static double sine_of_degrees(double degrees, int quarters) {
    double rest = fmod(degrees, 360.0);
    int quarter = (int)round(rest / 90.0);
    double radians = (rest - 90.0 * quarter) * pi / 180.0;
    switch ((quarter + quarters) & 3) {
    case 0:
        return sin(radians) + 0.0; // never -0
    case 1:
        return cos(radians);
    case 2:
        return 0.0 - sin(radians);
    default:
        return -cos(radians);
    }
}

FUNCTION(sin) {
    UNUSED_COUNT();
    double angle = arguments->number;
    value_set_number(result, vm.degrees ? sine_of_degrees(angle, 0) : sin(angle));
}

FUNCTION(cos) {
    UNUSED_COUNT();
    double angle = arguments->number;
    value_set_number(result, vm.degrees ? sine_of_degrees(angle, 1) : cos(angle));
}

FUNCTION(tan) {
    UNUSED_COUNT();
    double angle = arguments->number;
    set_checked(result,
                vm.degrees ? sine_of_degrees(angle, 0) / sine_of_degrees(angle, 1) : tan(angle));
}

// ---- To an angle --------------------------------------------------------------------------------

static void set_angle(value_t *result, double radians) {
    value_set_number(result, vm.degrees ? radians * 180.0 / pi : radians);
}

FUNCTION(atn) {
    UNUSED_COUNT();
    set_angle(result, atan(arguments->number));
}

FUNCTION(atan2) {
    UNUSED_COUNT();
    set_angle(result, atan2(arguments[0].number, arguments[1].number));
}

// From 0 to a full turn, clockwise from the y axis as on a compass.
FUNCTION(math_atan3) {
    UNUSED_COUNT();
    double radians = atan2(arguments[0].number, arguments[1].number);
    set_angle(result, radians < 0 ? radians + 2 * pi : radians);
}

static double in_unit_range(const value_t *argument) {
    if (fabs(argument->number) > 1.0) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    return argument->number;
}

FUNCTION(asin) {
    UNUSED_COUNT();
    set_angle(result, asin(in_unit_range(arguments)));
}

FUNCTION(acos) {
    UNUSED_COUNT();
    set_angle(result, acos(in_unit_range(arguments)));
}

// ---- Units --------------------------------------------------------------------------------------

FUNCTION(pi) {
    UNUSED_COUNT();
    (void)arguments;
    value_set_number(result, pi);
}

FUNCTION(rad) {
    UNUSED_COUNT();
    value_set_number(result, arguments->number * pi / 180.0);
}

FUNCTION(deg) {
    UNUSED_COUNT();
    set_checked(result, arguments->number * 180.0 / pi);
}
