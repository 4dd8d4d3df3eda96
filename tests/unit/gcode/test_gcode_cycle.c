// Canned cycles: what entries a line makes, from a recording sink; refusals; lines that do not fit
// at once.
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "gcode/gcode_interpreter.h"

// ---- The sink -----------------------------------------------------------------------------------

#define NO_LIMIT 100000u

static struct {
    char text[8192];
    size_t length;
    unsigned count;
    unsigned room; // entries that it still takes
    double lowest; // Z that it allows
    double place[AXIS_COUNT];
    uint32_t drops;
} sink;

static void note(const char *format, double a, double b, double c) {
    sink.length +=
        (size_t)snprintf(sink.text + sink.length, sizeof sink.text - sink.length, format, a, b, c);
}

static void target(double place[AXIS_COUNT]) {
    memcpy(place, sink.place, sizeof sink.place);
}

static err_t place(double here[AXIS_COUNT]) {
    target(here);
    return ERR_OK;
}

static err_t check(const gcode_entry_t *entry, double from[AXIS_COUNT]) {
    if (entry->kind != ENTRY_MOVE) {
        return ERR_OK;
    }
    memcpy(from, entry->arc.move.target, sizeof entry->arc.move.target);
    return from[AXIS_Z] < sink.lowest ? err_raise(ERR_SOFT_LIMIT, "Z") : ERR_OK;
}

static err_t push(const gcode_entry_t *entry) {
    if (sink.room == 0) {
        return err_raise(ERR_GCODE_BUFFER_FULL, NULL);
    }
    sink.room--;
    sink.count++;
    const double *to = entry->arc.move.target;
    if (entry->kind == ENTRY_DWELL) {
        note("wait %g;", entry->dwell.ms, 0, 0);
        return ERR_OK;
    }
    memcpy(sink.place, to, sizeof sink.place);
    TEST_ASSERT_TRUE(entry->arc.move.rapid || entry->arc.move.feed == 300);
    note(entry->arc.move.rapid ? "G0 %g %g %g;" : "G1 %g %g %g;", to[AXIS_X], to[AXIS_Y],
         to[AXIS_Z]);
    return ERR_OK;
}

static uint32_t drops(void) {
    return sink.drops;
}

static gcode_outputs_t outputs(void) {
    return (gcode_outputs_t){.spindle = STEPPER_SPINDLE_OFF};
}

static const gcode_sink_t recorder = {
    .target = target,
    .place = place,
    .check = check,
    .push = push,
    .drops = drops,
    .outputs = outputs,
};

static gcode_interpreter_t interpreter;

void setUp(void) {
    memset(&sink, 0, sizeof sink);
    sink.room = NO_LIMIT;
    sink.lowest = -100;
    const stepper_init_t init = {0.05, 32, PINS_NONE, false};
    const stepper_axis_t axis = {.enable_gpio = PINS_NONE,
                                 .steps_per_unit = 80,
                                 .max_velocity = 6000,
                                 .max_acceleration = 500,
                                 .home_backoff_mm = 3};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&init));
    for (axis_id_t i = 0; i < AXIS_COUNT; i++) {
        stepper_axis_t one = axis;
        one.step_gpio = (uint8_t)(2 + 2 * i);
        one.dir_gpio = (uint8_t)(3 + 2 * i);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_axis(i, &one));
    }
    gcode_interpreter_start(&interpreter, &recorder);
}

void tearDown(void) {
    stepper_close();
}

static err_t send(const char *text) {
    return gcode_interpreter_line(&interpreter, text, strlen(text));
}

static void line(const char *text) {
    err_t err = send(text);
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, err, err == ERR_OK ? text : err_message());
}

static void forget(void) {
    sink.length = 0;
    sink.text[0] = '\0';
}

// The entries since the last call.
static void expect(const char *text) {
    TEST_ASSERT_EQUAL_STRING(text, sink.text);
    forget();
}

// ---- What they do -------------------------------------------------------------------------------

static void test_drilling_at_several_places(void) {
    line("G0 Z5");
    expect("G0 0 0 5;");
    line("G98 G81 X1 Y2 Z-1 R2 F300");
    expect("G0 1 2 5;G0 1 2 2;G1 1 2 -1;G0 1 2 5;");
    line("X3");
    expect("G0 3 2 5;G0 3 2 2;G1 3 2 -1;G0 3 2 5;");
    line("G99 Y4 Z-2");
    expect("G0 3 4 5;G0 3 4 2;G1 3 4 -2;G0 3 4 2;");
    line("Y5 R1");
    expect("G0 3 5 2;G0 3 5 1;G1 3 5 -2;G0 3 5 1;");
    line("G98 Y6");
    expect("G0 3 6 1;G1 3 6 -2;G0 3 6 5;"); // the initial plane is that of the whole series
    line("G80");
    TEST_ASSERT_EQUAL(ERR_GCODE_NO_MOTION, send("X1"));
}

static void test_from_below_it_lifts_first(void) {
    line("G98 G81 X1 Z-1 R2 F300");
    expect("G0 0 0 2;G0 1 0 2;G1 1 0 -1;G0 1 0 2;");
}

static void test_where_it_stands(void) {
    line("G0 Z2");
    expect("G0 0 0 2;");
    line("G99 G81 Z-1 R2 F300");
    expect("G1 0 0 -1;G0 0 0 2;");
    line("G82 Z-1 R2 P250 L2");
    expect("G1 0 0 -1;wait 250;G0 0 0 2;G1 0 0 -1;wait 250;G0 0 0 2;");
}

static void test_relative_places_repeat(void) {
    line("G0 Z5 F300");
    expect("G0 0 0 5;");
    line("G91 G99 G81 X1 Y-1 Z-1 R-2 L3");
    expect("G0 1 -1 5;G0 1 -1 3;G1 1 -1 2;G0 1 -1 3;"
           "G0 2 -2 3;G1 2 -2 2;G0 2 -2 3;"
           "G0 3 -3 3;G1 3 -3 2;G0 3 -3 3;");
}

static void test_pecks(void) {
    line("G0 Z5 F300");
    expect("G0 0 0 5;");
    line("G99 G83 Z-2 R1 Q1.2");
    expect("G0 0 0 1;G1 0 0 -0.2;G0 0 0 1;G0 0 0 0.054;G1 0 0 -1.4;G0 0 0 1;G0 0 0 -1.146;"
           "G1 0 0 -2;G0 0 0 1;");
    line("G73 Z-2 R1 Q1.2");
    expect("G1 0 0 -0.2;G0 0 0 0.054;G1 0 0 -1.4;G0 0 0 -1.146;G1 0 0 -2;G0 0 0 1;");
    line("X1 Q9");
    expect("G0 1 0 1;G1 1 0 -2;G0 1 0 1;");
    line("X2 Q0.1 Z0.85"); // pecks smaller than the lift
    expect("G0 2 0 1;G1 2 0 0.9;G0 2 0 1;G1 2 0 0.85;G0 2 0 1;");
}

static void test_inches_offsets_and_the_other_dialect(void) {
    line("G10 L2 P2 X10 Y20 Z1");
    line("G55 G0 Z5 F300");
    expect("G0 0 0 6;");
    line("G20 G99 G81 X1 Y0 Z-0.1 R0.1");
    expect("G0 35.4 20 6;G0 35.4 20 3.54;G1 35.4 20 -1.54;G0 35.4 20 3.54;");
    interpreter.state.options.nist = true;
    line("G21 G82 X0 Z-1 R1 P1.5");
    expect("G0 10 20 3.54;G0 10 20 2;G1 10 20 0;wait 1500;G0 10 20 2;");
    line("X1"); // P stays in what it was given
    expect("G0 11 20 2;G1 11 20 0;wait 1500;G0 11 20 2;");
}

static void test_a_motion_between_begins_a_new_series(void) {
    line("G0 Z5 F300");
    line("G81 X1 Z-1 R2");
    line("G0 Z9");
    forget();
    line("G81 X2 Z-1 R2");
    expect("G0 2 0 9;G0 2 0 2;G1 2 0 -1;G0 2 0 9;");
    line("G0 X0");
    TEST_ASSERT_EQUAL(ERR_GCODE_NEEDS, send("G81 X1"));
}

static void test_g80_beside_a_motion_mode_says_nothing_more(void) {
    line("G00G21G17G90G40G49G80");
    line("X1");
    expect("G0 1 0 0;");
    line("G80 G1 X2 F300");
    expect("G1 2 0 0;");
}

// ---- What is refused ----------------------------------------------------------------------------

static void check_refused(const char *text, const char *message) {
    gcode_state_t before = interpreter.state;
    TEST_ASSERT_NOT_EQUAL_MESSAGE(ERR_OK, send(text), text);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(message, err_message(), text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&before, &interpreter.state, sizeof before, text);
    expect("");
}

static void test_refusals_change_nothing(void) {
    line("F300");
    check_refused("G81 X1 R2", "G81 needs Z, the depth");
    check_refused("G73 X1 Z-1 Q1", "G73 needs R, from where the way down is at the feed");
    check_refused("G83 X1 Z-1 R2", "G83 needs Q, the depth of each peck");
    check_refused("G82 X1 Z-1 R2", "G82 needs P, the time at the bottom");
    check_refused("G82 X1 Z-1 R2 P-1", "P: -1 is invalid (valid is 0 to 86400000)");
    check_refused("G83 X1 Z-1 R2 Q0", "Q: 0 is invalid (valid is above 0)");
    check_refused("G83 X1 Z-1 R2 Q-1", "Q: -1 is invalid (valid is above 0)");
    check_refused("G20 G83 X1 Z-1 R2 Q-1", "Q: -1 is invalid (valid is above 0)");
    check_refused("G81 X1 Z-1 R2 L0", "L: 0 is invalid (valid is 1 to 9999)");
    check_refused("G81 X1 Z-1 R2 L1.5", "L: 1.5 is no whole number");
    check_refused("G81 X1 Z-1 R2 L10000", "L: 10000 is invalid (valid is 1 to 9999)");
    check_refused("G81 X1 Z2 R1", "R of a canned cycle must not be below Z");
    check_refused("G81 X1 A1 Z-1 R2", "A cannot move in a canned cycle");
    check_refused("G83 X1 Z-10 R1 Q0.001", "A canned cycle of more than 2000 pecks in one line");
    check_refused("G18 G81 X1 Z-1 R2", "Canned cycles need G17, the XY plane");
    check_refused("G93 G81 X1 Z-1 R2 F9", "Not with G93: cycles");
    check_refused("G81 X1 Z-1 R2 Q1", "Nothing in this line uses Q");
    check_refused("G81 R2 Z-1 X1 P3", "Nothing in this line uses P");
    check_refused("G81", "G38 and canned cycles need an axis value");
}

static void test_the_whole_line_is_checked_before_anything_is_queued(void) {
    line("G0 Z5 F300");
    expect("G0 0 0 5;");
    sink.lowest = -2;
    check_refused("G83 X1 Z-2.5 R1 Q1", "Z position exceeds soft limits");
    line("G83 X1 Z-2 R1 Q1");
}

// ---- By and by ----------------------------------------------------------------------------------

static void test_what_does_not_fit_follows_later(void) {
    line("G0 Z5 F300");
    forget();
    sink.room = 2;
    line("G98 G82 X1 Z-1 R2 P5");
    expect("G0 1 0 5;G0 1 0 2;");
    TEST_ASSERT_TRUE(interpreter.busy);
    TEST_ASSERT_EQUAL(ERR_GCODE_BUFFER_FULL, send("X2"));
    sink.room = 1;
    gcode_interpreter_background(&interpreter);
    expect("G1 1 0 -1;");
    sink.room = NO_LIMIT;
    gcode_interpreter_background(&interpreter);
    expect("wait 5;G0 1 0 5;");
    TEST_ASSERT_FALSE(interpreter.busy);
    line("X2");
    expect("G0 2 0 5;G0 2 0 2;G1 2 0 -1;wait 5;G0 2 0 5;");
}

static void test_a_line_without_room_for_its_first_entry_has_done_nothing(void) {
    line("G0 Z5 F300");
    forget();
    sink.room = 0;
    check_refused("G81 X1 Z-1 R2", "G-code buffer full");
    sink.room = NO_LIMIT;
    line("G81 X1 Z-1 R2");
}

static void test_a_stop_drops_what_waits(void) {
    line("G0 Z5 F300");
    sink.room = 2;
    line("G81 X1 Z-1 R2");
    sink.drops++;
    sink.room = NO_LIMIT;
    forget();
    gcode_interpreter_background(&interpreter);
    TEST_ASSERT_FALSE(interpreter.busy);
    expect("");
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_drilling_at_several_places);
    RUN_TEST(test_from_below_it_lifts_first);
    RUN_TEST(test_where_it_stands);
    RUN_TEST(test_relative_places_repeat);
    RUN_TEST(test_pecks);
    RUN_TEST(test_inches_offsets_and_the_other_dialect);
    RUN_TEST(test_a_motion_between_begins_a_new_series);
    RUN_TEST(test_g80_beside_a_motion_mode_says_nothing_more);
    RUN_TEST(test_refusals_change_nothing);
    RUN_TEST(test_the_whole_line_is_checked_before_anything_is_queued);
    RUN_TEST(test_what_does_not_fit_follows_later);
    RUN_TEST(test_a_line_without_room_for_its_first_entry_has_done_nothing);
    RUN_TEST(test_a_stop_drops_what_waits);
    return UNITY_END();
}
