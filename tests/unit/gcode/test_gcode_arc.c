// Lines with arcs: which way they go, by what the motors reach; words, modes and refusals.
#include <math.h>
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "gcode/gcode.h"
#include "lines.h"

static const double scale[AXIS_COUNT] = {80, 80, 400, 10};

void setUp(void) {
    bench_start_with(NULL, 16, false);
    gcode_reset();
    TEST_ASSERT_EQUAL(ERR_OK, gcode_line("F3000", 5));
}

void tearDown(void) {
    bench_end();
}

static void check_refused(const char *text, const char *message) {
    uint32_t slots = stepper_blocks_free();
    TEST_ASSERT_NOT_EQUAL_MESSAGE(ERR_OK, lines_send(text), text);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(message, err_message(), text);
    TEST_ASSERT_EQUAL_UINT32(slots, stepper_blocks_free());
}

static void go(const char *text) {
    lines_check_ok(text);
    bench_finish(100);
}

// What an axis reached since check_way() began.
typedef struct {
    double low, high;
} reach_t;

// Carries the line out and checks how far the axis went and where it is then, in mm or degrees.
static void check_way(const char *text, axis_id_t axis, double low, double high, double end) {
    lines_check_ok(text);
    reach_t reach = {INFINITY, -INFINITY};
    do {
        double place = (double)bench.motors[axis].position_steps / scale[axis];
        reach.low = fmin(reach.low, place);
        reach.high = fmax(reach.high, place);
        bench_wait_us(200);
    } while (stepper_active() > 0);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.026, low, reach.low, text);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.026, high, reach.high, text);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.5001 / scale[axis], end, stepper_position(axis), text);
}

static void test_clockwise_and_counter_clockwise(void) {
    check_way("G2 X10 I5", AXIS_Y, 0, 5, 0);
    check_way("G2 X0 I-5 J0", AXIS_Y, -5, 0, 0);
    check_way("G3 X10 I5", AXIS_Y, -5, 0, 0);
    check_way("G3 X0 I-5", AXIS_Y, 0, 5, 0);
    check_way("G2 X5 Y5 I5", AXIS_X, 0, 5, 5);
    check_way("G3 X0 Y0 I-5", AXIS_Y, 0, 10, 0);
}

// Seen from the end of the axis that is not in the plane, towards zero.
static void test_planes(void) {
    check_way("G18 G2 X10 I5", AXIS_Z, -5, 0, 0); // Z X: from Z towards X is counter-clockwise
    check_way("G3 X0 I-5 K0", AXIS_Z, -5, 0, 0);
    check_way("G19 G2 Y10 J5", AXIS_Z, 0, 5, 0);
    check_way("G3 Y0 J-5", AXIS_Z, 0, 5, 0);
    check_way("G17 G2 X10 I5", AXIS_Y, 0, 5, 0);
    check_way("G18 G3 Z2 K1", AXIS_X, 9, 10, 10);
}

static void test_full_circles_and_turns(void) {
    check_way("G2 I5", AXIS_X, 0, 10, 0);
    check_way("G3 X0 Y0 J-3", AXIS_Y, -6, 0, 0);
    check_way("G3 J-3 X0 Y0 Z-2 P4", AXIS_Z, -2, 0, -2);
    check_way("G91 G2 I2", AXIS_X, 0, 4, 0);
    check_way("G2 X4 I2 P2", AXIS_X, 0, 4, 4);
}

// One circle of 10 mm at 50 mm/s takes 0.628 s and a tenth for its ramps; P says how often.
static void test_turns_take_their_time(void) {
    for (int turns = 1; turns <= 3; turns++) {
        char text[] = "G2 I10 P1";
        text[8] = (char)('0' + turns);
        lines_check_ok(text);
        TEST_ASSERT_DOUBLE_WITHIN(0.03, turns * 1.2566 + 0.115, bench_finish(10));
    }
}

static void test_radius(void) {
    check_way("G2 X10 R10", AXIS_Y, 0, 10 - sqrt(75), 0);
    check_way("G2 X0 R-10", AXIS_Y, -10 - sqrt(75), 0, 0); // the long way
    check_way("G3 X10 R10", AXIS_Y, -10 + sqrt(75), 0, 0);
    check_way("G3 X0 R-10", AXIS_Y, 0, 10 + sqrt(75), 0);
    check_way("G2 X10 R5", AXIS_Y, 0, 5, 0);
    check_way("G2 X0 R4.999", AXIS_Y, -5, 0, 0); // half a circle that was rounded
    check_way("G3 X10 R-4.98", AXIS_Y, -5, 0, 0);
    check_way("G18 G3 X0 R5 Z0", AXIS_Z, -5, 0, 0);
    check_way("G17 G2 X3 Y-4 R100", AXIS_X, 0, 3, 3);
}

static void test_modal_motion_and_distance(void) {
    lines_check_ok("G91 G2 X2 I1");
    check_way("X2 I1", AXIS_X, 0, 4, 4);
    check_way("G90 X0 I-2", AXIS_Y, -2, 0, 0);
    check_way("G91.1 G3 X4 I2", AXIS_Y, -2, 0, 0);
    check_way("G1 X0", AXIS_Y, 0, 0, 0);
    lines_check_ok("G92 X100 Y50");
    check_way("G2 X110 Y50 I5", AXIS_Y, 0, 5, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10, stepper_position(AXIS_X));
}

static void test_a_turns_along(void) {
    check_way("G2 X10 I5 A90", AXIS_A, 0, 90, 90);
    gcode_set_options(&(gcode_options_t){.arc_legacy = true});
    check_way("G2 X0 I-5 A0", AXIS_A, 90, 90, 90);
    check_way("G1 X10 A0", AXIS_A, 0, 90, 0); // lines are as always
    gcode_reset();
    check_way("G2 X0 I-5 A90 F3000", AXIS_A, 0, 90, 90);
}

static void test_rounded_coordinates(void) {
    go("G2 X7.0711 Y2.9289 I7.07 J-7.07"); // 0.001 mm off
    go("G1 X0 Y0");
    go("G2 X10.02 I5"); // a fiftieth off
    go("G1 X0 Y0");
    check_refused("G2 X10.1 I5", "The end is 0.100 mm off the arc");
    check_refused("G2 X10.03 I5", "The end is 0.030 mm off the arc");
    go("G2 X200.05 I100"); // but not a thousandth of the radius
    check_refused("G91 G2 X8003 I4000", "The end is 3.000 mm off the arc"); // ever
}

static void test_refusals(void) {
    check_refused("G2 X10", "An arc needs either its centre (I J) or R");
    check_refused("G2 X10 I5 R5", "An arc needs either its centre (I J) or R");
    check_refused("G18 G2 X10", "An arc needs either its centre (K I) or R");
    check_refused("G2 X10 I5 K1", "K is not in the plane of the arc");
    check_refused("G19 G2 Y10 I5", "I is not in the plane of the arc");
    check_refused("G2 X10 I0 J0", "The arc has no radius");
    check_refused("G2 I0", "The arc has no radius");
    check_refused("G2 X10 I10", "The arc has no radius"); // the end is the centre
    check_refused("G2 X10 R0", "The arc has no radius");
    check_refused("G2 X10 R4.9", "R is less than half the way to the end (5.000 mm)");
    check_refused("G2 X10 R-4.9", "R is less than half the way to the end (5.000 mm)");
    check_refused("G2 X0 Y0 R5",
                  "An arc with R must end elsewhere (give the centre for a full circle)");
    check_refused("G2 R5", "An arc with R must end elsewhere (give the centre for a full circle)");
    check_refused("G2 X10 I5 P0", "P: 0 is invalid (valid is whole turns, 1 to 100)");
    check_refused("G2 X10 I5 P1.5", "P: 1.5 is invalid (valid is whole turns, 1 to 100)");
    check_refused("G2 X10 I5 P101", "P: 101 is invalid (valid is whole turns, 1 to 100)");
    check_refused("G2 X10 I5 I4", "I given twice");
    check_refused("G2 X10 R5 R6", "R given twice");
    check_refused("G1 X10 I5", "Nothing in this line uses I");
    check_refused("G0 X10 R5", "Nothing in this line uses R");
    check_refused("G92 X10 R5", "Nothing in this line uses R");
    check_refused("G4 P5 G1 I1", "Nothing in this line uses I");
    check_refused("G17 G18", "Two planes in one line");
    check_refused("G2 G3 X10 I5", "Two motion modes in one line");
    check_refused("G2 X3 Y3 R9999999", "The radius of the arc is too large");
    check_refused("G2 X10 I99999999999", "The end is 10.000 mm off the arc");
    check_refused("G2 X10 I5 F0", "F: 0 is invalid (valid is 0.001 to 1e+09)");
    check_refused("I5", "Nothing in this line uses I");
    gcode_reset();
    check_refused("G2 X10 I5", "Feedrate not set (give F once, in mm/min)");
}

static void test_soft_limits_hold_on_the_whole_way(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_X, -10, 50));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_Y, -10, 10));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_limits(AXIS_Z, -5, 5));
    go("G2 X20 I10"); // just within
    check_refused("G2 X-0.2 I-10.1", "Y position exceeds soft limits");
    check_refused("G3 X0 R-10.2", "Y position exceeds soft limits");
    go("G3 X0 R10");
    check_refused("G2 I-5.1", "X position exceeds soft limits");
    go("G2 I-5");
    check_refused("G18 G3 X10 I5 J1", "J is not in the plane of the arc");
    check_refused("G18 G3 X10.4 I5.2", "Z position exceeds soft limits");
    go("G18 G3 X10 I5");
    check_refused("G17 G2 X0 I-5 Z6", "Z position exceeds soft limits");
    check_refused("G2 X0 I-5 A99999999999",
                  "A position is too far from zero for its steps per unit");
}

static bool plane_is(const char *code) {
    char modes[GCODE_MODES_SIZE];
    gcode_modes(modes);
    return strstr(modes, code) != NULL;
}

static void test_path_modes(void) {
    TEST_ASSERT_EQUAL(STEPPER_CORNER_CONTINUOUS, gcode_path().corner);
    lines_check_ok("G61");
    TEST_ASSERT_EQUAL(STEPPER_CORNER_EXACT, gcode_path().corner);
    lines_check_ok("G61.1 X1 G1");
    TEST_ASSERT_EQUAL(STEPPER_CORNER_STOP, gcode_path().corner);
    lines_check_ok("G64 P0.05");
    TEST_ASSERT_EQUAL(STEPPER_CORNER_BLEND, gcode_path().corner);
    TEST_ASSERT_EQUAL_DOUBLE(0.05, gcode_path().blend_mm);
    lines_check_ok("G64 P0");
    TEST_ASSERT_EQUAL(STEPPER_CORNER_CONTINUOUS, gcode_path().corner);
    lines_check_ok("G18 G64 P0.1 G1 X2");
    check_refused("G64 P-1", "P: -1 is invalid (valid is 0 to 1000)");
    check_refused("G61 P1", "Nothing in this line uses P");
    check_refused("G64 P1 G4", "P has two meanings in this line");
    check_refused("G64 P1 G2 X3 I0.5", "P has two meanings in this line");
    check_refused("G61 G64", "Two path modes in one line");
    TEST_ASSERT_EQUAL_DOUBLE(0.1, gcode_path().blend_mm);
    TEST_ASSERT_TRUE(plane_is(" G18 "));
    gcode_reset_modal();
    TEST_ASSERT_EQUAL(STEPPER_CORNER_CONTINUOUS, gcode_path().corner);
    TEST_ASSERT_TRUE(plane_is(" G17 "));
    bench_finish(10);
}

static void test_path_modes_reach_the_corners(void) {
    const char *const modes[] = {"G61.1", "G61", "G64", "G64 P0.5"};
    double time[4];
    for (int i = 0; i < 4; i++) {
        lines_check_ok(modes[i]);
        go("G1 X0 Y0 F3000");
        stepper_hold(true);
        lines_check_ok("X5");
        lines_check_ok("X10");
        lines_check_ok("Y5");
        lines_check_ok("Y10");
        stepper_hold(false);
        time[i] = bench_finish(10);
    }
    // Four times 5 mm, twice 10 mm from rest to rest with 500 mm/s^2.
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 4 * 2 * sqrt(5 / 500.0), time[0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2 * (0.1 + 0.2), time[1] + 0.0);
    TEST_ASSERT_TRUE(time[2] < time[1] - 0.005);
    TEST_ASSERT_TRUE(time[3] < time[2] - 0.005);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_clockwise_and_counter_clockwise);
    RUN_TEST(test_planes);
    RUN_TEST(test_full_circles_and_turns);
    RUN_TEST(test_turns_take_their_time);
    RUN_TEST(test_radius);
    RUN_TEST(test_modal_motion_and_distance);
    RUN_TEST(test_a_turns_along);
    RUN_TEST(test_rounded_coordinates);
    RUN_TEST(test_refusals);
    RUN_TEST(test_soft_limits_hold_on_the_whole_way);
    RUN_TEST(test_path_modes);
    RUN_TEST(test_path_modes_reach_the_corners);
    return UNITY_END();
}
