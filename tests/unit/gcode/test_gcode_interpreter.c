// Lines of several entries: what waits for room, for homing or probing, and what becomes of it when
// the queue is dropped. And the options.
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "recorder.h"

static gcode_interpreter_t *const in = &recorder.interpreter;

void setUp(void) {
    bench_start(); // its axes are asked for
    recorder_start();
}

void tearDown(void) {
    bench_end();
}

static void send(const char *line, const char *entries) {
    err_t err = recorder_send(line);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, err, err == ERR_OK ? line : err_message());
    TEST_ASSERT_EQUAL_STRING_MESSAGE(entries, recorder.text, line);
}

static void refuse(const char *line, err_t expected) {
    TEST_ASSERT_EQUAL_MESSAGE(expected, recorder_send(line), line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", recorder.text, line);
}

static void go_on(uint32_t room, const char *entries) {
    recorder.room = room;
    recorder_clear();
    gcode_interpreter_background(in);
    TEST_ASSERT_EQUAL_STRING(entries, recorder.text);
}

static void test_what_has_no_room_follows_in_order(void) {
    recorder.room = 2;
    send("T1 M6 M3 S100 G1 X1 F100", "tool 1; spindle cw 100");
    TEST_ASSERT_TRUE(in->busy);
    TEST_ASSERT_EQUAL_UINT8(MOTION_FEED, in->state.modal.motion); // the line is accepted
    refuse("X2", ERR_GCODE_BUFFER_FULL);
    go_on(0, "");
    TEST_ASSERT_TRUE(in->busy);
    go_on(5, "line 1 0 0 0 F100");
    TEST_ASSERT_FALSE(in->busy);
    send("X2", "line 2 0 0 0 F100");
}

static void test_the_next_line_takes_what_waits_along(void) {
    recorder.room = 1;
    send("M3 G0 X1", "spindle cw 0");
    recorder.room = 2;
    send("X2", "rapid 1 0 0 0; rapid 2 0 0 0");
}

static void test_without_any_room_nothing_has_happened(void) {
    send("G91 G0 X1", "rapid 1 0 0 0");
    gcode_state_t before;
    memcpy(&before, &in->state, sizeof before);
    recorder.room = 0;
    refuse("G90 G20 M3 S5 T7 G54 G1 X9 F5", ERR_GCODE_BUFFER_FULL);
    refuse("G90 G55 G10 L2 P2 X5 M5", ERR_GCODE_BUFFER_FULL);
    refuse("G90 G0 X5", ERR_GCODE_BUFFER_FULL);
    TEST_ASSERT_EQUAL_MEMORY(&before, &in->state, sizeof before);
    TEST_ASSERT_FALSE(in->busy);
}

static void test_a_drop_takes_what_waits_along(void) {
    recorder.room = 1;
    send("M3 S100 G1 X1 F100 M8", "spindle cw 100");
    recorder.spindle = STEPPER_SPINDLE_OFF; // as a stop leaves it
    recorder.drops++;
    go_on(5, "");
    TEST_ASSERT_FALSE(in->busy);
    TEST_ASSERT_EQUAL_UINT8(STEPPER_SPINDLE_OFF, in->state.modal.spindle);
    TEST_ASSERT_FALSE(in->state.modal.flood);
    TEST_ASSERT_EQUAL(ERR_OK, gcode_interpreter_failure(in));
    send("S200", ""); // no spindle that turns
}

static void test_a_stop_under_way_is_no_failure(void) {
    recorder.room = 1;
    send("M3 G0 X1", "spindle cw 0");
    recorder.fails = ERR_STEPPER_STOPPING;
    go_on(5, "");
    TEST_ASSERT_EQUAL(ERR_OK, gcode_interpreter_failure(in));
    TEST_ASSERT_TRUE(in->busy);
    recorder.fails = ERR_OK;
    recorder.drops++;
    go_on(5, "");
    TEST_ASSERT_FALSE(in->busy);
}

static void test_what_fails_later_is_told_once(void) {
    recorder.room = 1;
    send("M3 G0 X1 M0", "spindle cw 0");
    recorder.fails = ERR_POSITION_UNKNOWN;
    go_on(5, "");
    TEST_ASSERT_FALSE(in->busy);
    TEST_ASSERT_EQUAL(ERR_POSITION_UNKNOWN, gcode_interpreter_failure(in));
    TEST_ASSERT_EQUAL_STRING("Machine position unknown - use STEPPER POSITION or G28 homing first",
                             err_message());
    TEST_ASSERT_EQUAL(ERR_OK, gcode_interpreter_failure(in));
}

static void test_homing_is_waited_for(void) {
    recorder.ended = false;
    send("G28 Z0 M0", "home 4");
    TEST_ASSERT_TRUE(in->waits);
    go_on(UINT32_MAX, "");
    refuse("G0 X1", ERR_GCODE_BUFFER_FULL);
    recorder.drops++; // homing drops the rest of its moves
    go_on(UINT32_MAX, "");
    TEST_ASSERT_TRUE(in->waits);
    recorder.ended = true;
    go_on(UINT32_MAX, "pause");
    TEST_ASSERT_FALSE(in->busy);
    send("G0 X1", "rapid 1 0 0 0");
}

static void test_homing_that_fails_ends_the_line(void) {
    recorder.ended = false;
    send("G28 M30", "home 0");
    recorder.ended = true;
    recorder.result = ERR_HOMING_FAILED;
    go_on(UINT32_MAX, "");
    TEST_ASSERT_FALSE(in->busy);
    TEST_ASSERT_FALSE(in->waits);
    TEST_ASSERT_FALSE(in->ended);
    TEST_ASSERT_EQUAL(ERR_HOMING_FAILED, gcode_interpreter_failure(in));
    TEST_ASSERT_EQUAL(ERR_OK, gcode_interpreter_failure(in));
}

static void test_the_end_of_a_program_is_told_when_all_is_queued(void) {
    recorder.room = 1;
    send("M3 G0 X1 M30", "spindle cw 0");
    TEST_ASSERT_FALSE(in->ended);
    go_on(2, "rapid 1 0 0 0; spindle off 0");
    TEST_ASSERT_FALSE(in->ended);
    go_on(1, "end");
    TEST_ASSERT_TRUE(in->ended);
}

static void test_options(void) {
    send("/G0 X1", "rapid 1 0 0 0");
    send("M1", "");
    in->state.options.block_delete = true;
    in->state.options.optional_stop = true;
    send("/G0 X2", "");
    send("  / G0 X#", ""); // not even read
    send("G0 X3", "rapid 3 0 0 0");
    send("M1", "pause");
}

static void test_the_standard_dialect(void) {
    in->state.options.nist = true;
    send("G4 P1.5", "dwell 1500");
    refuse("G4 P86401", ERR_GCODE_RANGE);
    refuse("G28", ERR_GCODE_NOT_STORED);
    send("G28.2 X0", "home 1");
    send("G0 X5 Y6", "rapid 5 6 0 0");
    send("G28.1", "");
    send("G0 X0 Y0", "rapid 0 0 0 0");
    send("G91 G28 Z1", "rapid 0 0 1 0 exact; rapid 0 0 0 0 exact");
    send("G28", "rapid 5 6 0 0 exact");
    refuse("G28 P1", ERR_GCODE_UNUSED);
}

static void test_messages_are_told_with_accepted_lines(void) {
    send("(MSG,Mind the clamp) G0 X1", "rapid 1 0 0 0");
    TEST_ASSERT_EQUAL_STRING("Mind the clamp", recorder.message);
    recorder.message[0] = '\0';
    refuse("(msg, again) G0 X1 Q1", ERR_GCODE_UNUSED);
    TEST_ASSERT_EQUAL_STRING("", recorder.message);
    send("( msg, again)", "");
    TEST_ASSERT_EQUAL_STRING(" again", recorder.message);
    recorder.message[0] = '\0';
    send("(MSGX, no) (print, no) ;MSG,no", "");
    TEST_ASSERT_EQUAL_STRING("", recorder.message);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_has_no_room_follows_in_order);
    RUN_TEST(test_the_next_line_takes_what_waits_along);
    RUN_TEST(test_without_any_room_nothing_has_happened);
    RUN_TEST(test_a_drop_takes_what_waits_along);
    RUN_TEST(test_a_stop_under_way_is_no_failure);
    RUN_TEST(test_what_fails_later_is_told_once);
    RUN_TEST(test_homing_is_waited_for);
    RUN_TEST(test_homing_that_fails_ends_the_line);
    RUN_TEST(test_the_end_of_a_program_is_told_when_all_is_queued);
    RUN_TEST(test_options);
    RUN_TEST(test_the_standard_dialect);
    RUN_TEST(test_messages_are_told_with_accepted_lines);
    return UNITY_END();
}
