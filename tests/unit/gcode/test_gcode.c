// G-code lines: spacing, comments, modal state, combinations, refusals that change nothing.
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "gcode/gcode.h"
#include "lines.h"
#include "stepper/stepper_outputs.h"

void setUp(void) {
    bench_start_with(NULL, STEPPER_BLOCKS_MAX, false);
    gcode_reset();
}

void tearDown(void) {
    bench_end();
}

static void check_refused(const char *text, const char *message) {
    double before[AXIS_COUNT];
    double after[AXIS_COUNT];
    uint32_t slots = stepper_blocks_free();
    stepper_target(before);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(ERR_OK, lines_send(text), text);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(message, err_message(), text);
    stepper_target(after);
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(before, after, AXIS_COUNT);
    TEST_ASSERT_EQUAL_UINT32(slots, stepper_blocks_free());
}

static void check_target(double x, double y, double z, double a) {
    double target[AXIS_COUNT];
    stepper_target(target);
    const double expected[AXIS_COUNT] = {x, y, z, a};
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(expected, target, AXIS_COUNT);
}

static void test_words_in_any_order_and_spacing(void) {
    lines_check_ok("G1X1Y2F600");
    check_target(1, 2, 0, 0);
    lines_check_ok("f 300  x- 2.5 g01 , y+3");
    check_target(-2.5, 3, 0, 0);
    lines_check_ok("\tz.5\tX1.");
    check_target(1, 3, 0.5, 0);
    lines_check_ok("Y0X10"); // not hexadecimal
    check_target(10, 0, 0.5, 0);
    lines_check_ok("G0A-90");
    check_target(10, 0, 0.5, -90);
}

static void test_comments(void) {
    lines_check_ok("");
    lines_check_ok("   ");
    lines_check_ok("; all of it");
    lines_check_ok("(alone)");
    lines_check_ok("' BASIC's own");
    check_target(0, 0, 0, 0);
    lines_check_ok("G1 (fast) X1 (to the right) F600 ; X9");
    lines_check_ok("Y1 ' and back Y9");
    lines_check_ok("Y2 (never closed X9");
    lines_check_ok("Y(in between)3");
    check_target(1, 3, 0, 0);
}

static void test_modes_stay(void) {
    lines_check_ok("F600");
    lines_check_ok("G1");
    lines_check_ok("X1");
    lines_check_ok("G91");
    lines_check_ok("X1 Y1");
    lines_check_ok("X1");
    check_target(3, 1, 0, 0);
    lines_check_ok("G90 X1");
    check_target(1, 1, 0, 0);
    lines_check_ok("G0");
    lines_check_ok("X5");
    check_target(5, 1, 0, 0);
}

static void test_offsets(void) {
    lines_check_ok("G0 X50");
    lines_check_ok("G92 X0 Y-1");
    TEST_ASSERT_EQUAL_DOUBLE(50, gcode_offset(AXIS_X));
    lines_check_ok("G1 X10 Y0 F600");
    check_target(60, 1, 0, 0);
    lines_check_ok("G91 X1");
    check_target(61, 1, 0, 0);
    gcode_clear_offsets();
    lines_check_ok("G90 X10");
    check_target(10, 1, 0, 0);
}

static void test_refusals_name_their_reason(void) {
    check_refused("X10", "No motion mode - start with G0, G1, G2 or G3");
    check_refused("G1 X10", "Feedrate not set (give F once, in mm/min)");
    check_refused("G1X10Y0X5 F100", "X given twice");
    check_refused("G1 X F100", "Missing value for X");
    check_refused("G1 X--1", "Missing value for X");
    check_refused("G1 X1 F0", "F: 0 is invalid (valid is 0.001 to 1e+09)");
    check_refused("G1 X1 F0.0009", "F: 0.0009 is invalid (valid is 0.001 to 1e+09)");
    check_refused("G1 X1 F-5", "F: -5 is invalid (valid is 0.001 to 1e+09)");
    check_refused("G1 X1 E5 F100", "Unknown parameter E");
    check_refused("G5 X1", "Unsupported code G5");
    check_refused("G1.1 X1", "Unsupported code G1.1");
    check_refused("G1.00001 X1", "Unsupported code G1.00001");
    check_refused("G90.2", "Unsupported code G90.2");
    check_refused("G92.4", "Unsupported code G92.4");
    check_refused("G-1", "Unsupported code G-1");
    check_refused("M31", "Unsupported code M31");
    check_refused("G0 G1 X1", "Two motion modes in one line");
    check_refused("G90 G91", "Two distance modes in one line");
    check_refused("G4", "G4 requires P value");
    check_refused("G4 P-1", "P: -1 is invalid (valid is 0 to 86400000)");
    check_refused("G92 G0 X1", "Two codes of this line use axis words (G92 and a motion mode)");
    check_refused("M3 M5", "Two codes out of M3, M4 and M5 in one line");
    check_refused("G0 X1 P5", "Nothing in this line uses P");
    check_refused("G92", "G92 requires an axis value");
    check_refused("#5", "Unexpected # in G-code");
    check_refused("\x80", "Unexpected byte 128 in G-code");
    check_refused("G0 X1e99999999", "Unknown parameter E"); // no exponents in G-code
    check_refused("G0 X99999999999", "X position is too far from zero for its steps per unit");
}

static void test_a_refused_line_leaves_the_modes(void) {
    lines_check_ok("G1 F600 X1");
    check_refused("G0 G91 F100 X1 Q5", "Nothing in this line uses Q");
    lines_check_ok("X2"); // still G90
    check_target(2, 0, 0, 0);
}

static void test_too_many_words(void) {
    char text[200] = "";
    for (int i = 0; i < GCODE_WORDS_MAX + 1; i++) {
        strcat(text, "X1");
    }
    check_refused(text, "Too many words in G-code line");
}

static void test_full_queue_refuses_and_keeps_the_modes(void) {
    stepper_estop(); // disarmed: the queue only fills
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    lines_check_ok("G1 F600 G91");
    while (stepper_blocks_free() > 0) {
        lines_check_ok("X0.1");
    }
    check_refused("G90 G0 X5", "G-code buffer full");
    stepper_run(STEPPER_IDLE_HOLD);
    while (stepper_blocks_free() == 0) {
        bench_wait_us(1000);
    }
    lines_check_ok("X0.1"); // still relative
    check_target(102.5, 0, 0, 0);
    bench_finish(100);
    TEST_ASSERT_EQUAL_INT64(8200, bench.motors[AXIS_X].position_steps);
}

static void test_dwell_and_spindle_lines(void) {
    lines_check_ok("G4 P250");
    lines_check_ok("M3");
    lines_check_ok("m05");
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0.25, bench_finish(1));
}

static void reach_pause(void) {
    for (unsigned i = 0; i < 1000 && !stepper_paused(); i++) {
        bench_wait_us(1000);
    }
    TEST_ASSERT_TRUE(stepper_paused());
}

static void go_on(void) {
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
    bench_wait_us(5000);
}

// The machine comes to them much later; each is asked for when it has.
static void test_pauses_know_their_tools(void) {
    uint32_t tool;
    TEST_ASSERT_FALSE(gcode_take_pause(&tool));
    lines_check_ok("T3 M6");
    lines_check_ok("G0 X1 M0");
    for (int i = 0; i < 10; i++) {
        lines_check_ok("M6 T9");
    }
    for (unsigned i = 0; i < 12; i++) {
        reach_pause();
        TEST_ASSERT_EQUAL(i < 8, gcode_take_pause(&tool)); // it keeps eight
        if (i < 8) {
            TEST_ASSERT_EQUAL_UINT32(i == 0 ? 3 : i == 1 ? GCODE_NO_TOOL : 9, tool);
        }
        go_on();
    }
    lines_check_ok("M6 T4");
    reach_pause();
    TEST_ASSERT_TRUE(gcode_take_pause(&tool));
    TEST_ASSERT_EQUAL_UINT32(4, tool);
    TEST_ASSERT_FALSE(gcode_take_pause(&tool));
    go_on();
    lines_check_ok("M6 T6"); // over before anybody has asked
    reach_pause();
    go_on();
    lines_check_ok("M0");
    reach_pause();
    TEST_ASSERT_TRUE(gcode_take_pause(&tool));
    TEST_ASSERT_EQUAL_UINT32(GCODE_NO_TOOL, tool);
    go_on();
    lines_check_ok("M6 T5");
    stepper_stop();
    bench_finish(1);
    TEST_ASSERT_FALSE(gcode_take_pause(&tool));
    bench_finish(1);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_words_in_any_order_and_spacing);
    RUN_TEST(test_comments);
    RUN_TEST(test_modes_stay);
    RUN_TEST(test_offsets);
    RUN_TEST(test_refusals_name_their_reason);
    RUN_TEST(test_a_refused_line_leaves_the_modes);
    RUN_TEST(test_too_many_words);
    RUN_TEST(test_full_queue_refuses_and_keeps_the_modes);
    RUN_TEST(test_dwell_and_spindle_lines);
    RUN_TEST(test_pauses_know_their_tools);
    return UNITY_END();
}
