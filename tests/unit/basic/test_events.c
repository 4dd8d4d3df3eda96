// Interrupts of a program in virtual time: ticks to the microsecond and over hours, keys, events of
// the product, what is cleared when, and the hooks.
#include <string.h>

#include <unity.h>

#include "board.h"
#include "basic/events.h"

#define MARKS_MAX 64
#define STATEMENT_US 10 // of board.c
#define DOOR (BASIC_EVENT_PRODUCT + 3)

static struct {
    uint64_t at_us[MARKS_MAX]; // the first ones
    uint64_t last_us;
    unsigned count;
    int64_t value;
} marks;

// The moment a program says MARK.
static err_t mark(const basic_arg_t *args, size_t count) {
    (void)count;
    if (marks.count < MARKS_MAX) {
        marks.at_us[marks.count] = board.time_us;
    }
    marks.last_us = board.time_us;
    marks.count++;
    marks.value = args[0].integer;
    return ERR_OK;
}

static err_t on_door(const basic_arg_t *args, size_t count) {
    (void)count;
    basic_set_event(DOOR, (basic_routine_t)args[0].integer);
    return ERR_OK;
}

static err_t open_door(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    basic_raise_event(DOOR);
    return ERR_OK;
}

static const basic_arg_spec_t mark_args[] = {
    {.name = "value", .kind = BASIC_ARG_INTEGER, .flags = BASIC_ARG_DEFAULT}};
static const basic_arg_spec_t door_args[] = {
    {.name = "sub", .kind = BASIC_ARG_ROUTINE, .flags = BASIC_ARG_OPTIONAL}};
static const basic_command_t commands[] = {
    {"MARK", mark_args, 1, mark, NULL},
    {"ON DOOR", door_args, 1, on_door, NULL},
    {"DOOR", door_args, 1, on_door, NULL},
    {"KNOCK", NULL, 0, open_door, NULL},
};

void setUp(void) {
    board_reset();
    memset(&marks, 0, sizeof marks);
    board_start(commands, 4, NULL, 0);
}
void tearDown(void) {}

static const char *run(const char *source) {
    board_shown();
    basic_run_program(source, strlen(source));
    return board_shown();
}

// ---- Ticks --------------------------------------------------------------------------------------

static void test_a_tick_comes_on_time(void) {
    run("SETTICK 10, t\nMARK 0\nPAUSE 105\nSETTICK 0, 0\nPAUSE 100\nEND\n"
        "SUB t\nMARK 1\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(11, marks.count);
    for (unsigned i = 1; i < 11; i++) { // the first mark came a statement behind SETTICK
        uint64_t due_us = marks.at_us[0] - STATEMENT_US + i * 10000;
        TEST_ASSERT_EQUAL_UINT64(due_us + STATEMENT_US, marks.at_us[i]);
    }
}

static void test_a_pause_is_as_long_as_without_events(void) {
    run("SETTICK 1, t\nMARK 1\nPAUSE 50\nMARK 2\nEND\nSUB t\nn = n + 1\nEND SUB\n");
    TEST_ASSERT_UINT64_WITHIN(5 * STATEMENT_US, 50000, marks.at_us[1] - marks.at_us[0]);
}

// The program is between two statements, in a PAUSE or in the SUB when a tick is due.
static void test_an_hour_without_drift(void) {
    const uint64_t ticks = 3600 * 100;
    run("SETTICK 10, t\nDO\nPAUSE 0.3\nFOR i = 1 TO 20: NEXT\nLOOP UNTIL TIMER > 3600005\nEND\n"
        "SUB t\nMARK\nPAUSE 0.777\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(ticks, marks.count);
    TEST_ASSERT_UINT64_WITHIN(3 * STATEMENT_US, marks.at_us[0] + (ticks - 1) * 10000,
                              marks.last_us);
}

static void test_a_busy_program_is_interrupted_too(void) {
    run("SETTICK 10, t\nMARK 0\nDO\nLOOP UNTIL TIMER > 100\nEND\nSUB t\nMARK 1\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(11, marks.count);
    TEST_ASSERT_UINT64_WITHIN(5 * STATEMENT_US, marks.at_us[0] + 90000, marks.at_us[9]);
}

static void test_missed_ticks_are_one_and_the_beat_is_kept(void) {
    run("SETTICK 10, t\nMARK\nPAUSE 100\nEND\nSUB t\nMARK\nIF n = 0 THEN PAUSE 34\nn = 1\nEND "
        "SUB\n");
    uint64_t start_us = marks.at_us[0];
    // at 10, held up until 44: one more at once, then at 50 and on
    TEST_ASSERT_UINT64_WITHIN(10 * STATEMENT_US, start_us + 10000, marks.at_us[1]);
    TEST_ASSERT_UINT64_WITHIN(10 * STATEMENT_US, start_us + 44000, marks.at_us[2]);
    TEST_ASSERT_UINT64_WITHIN(10 * STATEMENT_US, start_us + 50000, marks.at_us[3]);
    TEST_ASSERT_UINT64_WITHIN(10 * STATEMENT_US, start_us + 60000, marks.at_us[4]);
    TEST_ASSERT_EQUAL_UINT(9, marks.count);
}

static void test_a_sub_that_takes_longer_than_its_tick_does_not_starve_the_program(void) {
    const char *shown = run("SETTICK 1, t\nFOR i = 1 TO 20: NEXT\nPRINT \"through\"\nEND\n"
                            "SUB t\nPAUSE 3\nEND SUB\n");
    TEST_ASSERT_NOT_NULL(strstr(shown, "through\r\n"));
}

static void test_ctrl_c_ends_a_program_whose_ticks_never_leave_it_alone(void) {
    board_type_at(500000, "\x03");
    run("SETTICK 0.1, t\nDO: LOOP\nSUB t\nPAUSE 1\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_LESS_THAN_UINT64(501000, board.time_us);
}

static void test_a_tick_stops_with_its_program(void) {
    run("SETTICK 5, t\nPAUSE 12\nEND\nSUB t\nMARK\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(2, marks.count);
    board_session("PAUSE 100\r");
    TEST_ASSERT_EQUAL_UINT(2, marks.count);
    board_session("SETTICK 5, t: PAUSE 12\rPAUSE 100\r");
    TEST_ASSERT_EQUAL_UINT(4, marks.count);
}

// ---- Calls --------------------------------------------------------------------------------------

static void test_subs_of_events_take_turns_and_do_not_nest(void) {
    const char *shown = run("SETTICK 10, a\nSETTICK 10, b, 2\nPAUSE 35\nEND\n"
                            "SUB a\nPRINT \"a\";\nPAUSE 15\nPRINT \"A\";\nEND SUB\n"
                            "SUB b\nPRINT \"b\";\nPAUSE 1\nPRINT \"B\";\nEND SUB\n");
    TEST_ASSERT_EQUAL_STRING("aAbBaAbB", shown);
}

static void test_an_event_waits_while_calls_are_as_deep_as_they_may_be(void) {
    const char *shown =
        run("SETTICK 1, t\nPRINT f(120)\nPAUSE 5\nPRINT n > 0\nEND\n"
            "FUNCTION f(d)\nIF d > 0 THEN\nf = 1 + f(d - 1)\nELSE\nPAUSE 10\nENDIF\n"
            "END FUNCTION\nSUB t\nn = n + 1\nEND SUB\n");
    TEST_ASSERT_EQUAL_STRING(" 120\r\n 1\r\n", shown);
}

static void test_a_long_pause_with_ticks_and_an_error_text_takes_no_memory(void) {
    const char *shown = run("ON ERROR IGNORE\nDIM s$\nERROR STRING$(100, \"x\")\nSETTICK 1, t\n"
                            "PAUSE 10000\nPRINT LEN(MM.ERRMSG$); n\nEND\n"
                            "SUB t\nLOCAL l$\nl$ = \"a\" + STR$(n)\nn = n + 1\nEND SUB\n");
    TEST_ASSERT_EQUAL_STRING(" 100 10000\r\n", shown);
}

// ---- Keys ---------------------------------------------------------------------------------------

static void test_on_key_calls_until_the_key_is_read(void) {
    board_type_at(20000, "q");
    const char *shown = run("ON KEY k\nPAUSE 100\nPRINT n; \" \"; c$\nEND\n"
                            "SUB k\nn = n + 1\nMARK\nIF n = 3 THEN c$ = INKEY$\nEND SUB\n");
    TEST_ASSERT_EQUAL_STRING(" 3 q\r\n", shown);
    TEST_ASSERT_UINT64_WITHIN(5 * STATEMENT_US, 20000, marks.at_us[0]);
}

static void test_on_key_code_takes_this_key_only(void) {
    board_type_at(20000, "a");
    board_type_at(30000, "s");
    board_type_at(40000, "b");
    const char *shown =
        run("ON KEY ASC(\"s\"), k\nPAUSE 100\nPRINT INKEY$; INKEY$; INKEY$; n\nEND\n"
            "SUB k\nn = n + 1\nMARK\nEND SUB\n");
    TEST_ASSERT_EQUAL_STRING("ab 1\r\n", shown);
    TEST_ASSERT_UINT64_WITHIN(5 * STATEMENT_US, 30000, marks.at_us[0]);
}

static void test_the_key_is_input_again_at_the_prompt(void) {
    run("ON KEY ASC(\"s\"), k\nEND\nSUB k\nEND SUB\n");
    TEST_ASSERT_NOT_NULL(strstr(board_session("PRINT \"s\"\r"), "\r\ns\r\n"));
}

// ---- The product's ------------------------------------------------------------------------------

static void knock_at_20_ms(void) {
    static bool done;
    if (board.time_us < 20000) {
        done = false;
    } else if (!done) {
        done = true;
        basic_raise_event(DOOR);
        basic_raise_event(DOOR);
    }
}

static void test_an_event_raised_by_the_background_ends_the_wait(void) {
    board.on_background = knock_at_20_ms;
    run("DOOR d\nSETTICK 20, x\nPAUSE 50\nEND\nSUB d\nMARK 4\nEND SUB\nSUB x\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(1, marks.count);
    TEST_ASSERT_EQUAL_INT64(4, marks.value);
    TEST_ASSERT_UINT64_WITHIN(10 * STATEMENT_US, 20000, marks.at_us[0]);
}

static void test_an_event_without_a_sub_is_forgotten(void) {
    run("KNOCK\nDOOR d\nPAUSE 1\nKNOCK\nDOOR 0\nPAUSE 1\nDOOR d\nPAUSE 1\nEND\nSUB d\nMARK\nEND "
        "SUB\n");
    TEST_ASSERT_EQUAL_UINT(1, marks.count); // the second knock, between its statement and DOOR 0
}

static void test_the_argument_is_a_sub(void) {
    const char *subs = "END\nSUB d\nMARK\nEND SUB\nSUB e x\nEND SUB\nFUNCTION f()\nEND FUNCTION\n";
    char source[200];
    static const char *const wrong[][2] = {
        {"DOOR nobody", "Error : Unknown user subroutine"},
        {"DOOR e", "Error : E: the SUB must have no parameters"},
        {"DOOR \"f\"", "Error : Unknown user subroutine"},
        {"DOOR 7", "Error : sub: expected the name of a SUB"},
    };
    for (unsigned i = 0; i < 4; i++) {
        snprintf(source, sizeof source, "%s\n%s", wrong[i][0], subs);
        TEST_ASSERT_NOT_NULL(strstr(run(source), wrong[i][1]));
    }
    static const char *const right[] = {"DOOR d", "DOOR \"D\"", "s$ = \"d\": DOOR s$",
                                        "DOOR \"\"+\"d\""};
    for (unsigned i = 0; i < 4; i++) {
        snprintf(source, sizeof source, "%s:KNOCK:PAUSE 0:%s", right[i], subs);
        run(source);
        TEST_ASSERT_EQUAL_UINT(i + 1, marks.count);
    }
}

// ---- The hooks ----------------------------------------------------------------------------------

static void test_on_error_is_for_programs(void) {
    run("PRINT 1 / 0\n");
    TEST_ASSERT_EQUAL_UINT(1, board.errors);
    run("ON ERROR IGNORE\nPRINT 1 / 0\n");
    board_session("PRINT 1 / 0\rNOSUCH\r");
    TEST_ASSERT_EQUAL_UINT(1, board.errors);
    run("SETTICK 1, t\nPAUSE 10\nMARK\nEND\nSUB t\nPRINT 1 / 0\nEND SUB\n");
    TEST_ASSERT_EQUAL_UINT(2, board.errors);
    TEST_ASSERT_EQUAL_UINT(0, marks.count);
}

static void test_on_clear_comes_with_run_and_new(void) {
    run("a = 1\n");
    unsigned before = board.clears;
    board_session("PRINT a\rb = 2\r");
    TEST_ASSERT_EQUAL_UINT(before, board.clears);
    board_session("RUN\r");
    TEST_ASSERT_EQUAL_UINT(before + 1, board.clears);
    board_session("NEW\r");
    TEST_ASSERT_GREATER_THAN_UINT(before + 1, board.clears);
}

static void test_mm_end_comes_with_the_end_only(void) {
    const char *end = "SUB MM.END\nPRINT \"end\"; x\nEND SUB\n";
    char source[200];
    static const char *const lines[][2] = {
        {"x = 7", " end 7"}, {"x = 8: END: PRINT 1", " end 8"}, {"x = 1/0", ""}, {"END NOEND", ""}};
    for (unsigned i = 0; i < 4; i++) {
        snprintf(source, sizeof source, "%s\n%s", lines[i][0], end);
        const char *shown = run(source);
        TEST_ASSERT_EQUAL(lines[i][1][0] != '\0', strstr(shown, "end") != NULL && shown[0] == 'e');
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_tick_comes_on_time);
    RUN_TEST(test_a_pause_is_as_long_as_without_events);
    RUN_TEST(test_an_hour_without_drift);
    RUN_TEST(test_a_busy_program_is_interrupted_too);
    RUN_TEST(test_missed_ticks_are_one_and_the_beat_is_kept);
    RUN_TEST(test_a_sub_that_takes_longer_than_its_tick_does_not_starve_the_program);
    RUN_TEST(test_ctrl_c_ends_a_program_whose_ticks_never_leave_it_alone);
    RUN_TEST(test_a_tick_stops_with_its_program);
    RUN_TEST(test_subs_of_events_take_turns_and_do_not_nest);
    RUN_TEST(test_an_event_waits_while_calls_are_as_deep_as_they_may_be);
    RUN_TEST(test_a_long_pause_with_ticks_and_an_error_text_takes_no_memory);
    RUN_TEST(test_on_key_calls_until_the_key_is_read);
    RUN_TEST(test_on_key_code_takes_this_key_only);
    RUN_TEST(test_the_key_is_input_again_at_the_prompt);
    RUN_TEST(test_an_event_raised_by_the_background_ends_the_wait);
    RUN_TEST(test_an_event_without_a_sub_is_forgotten);
    RUN_TEST(test_the_argument_is_a_sub);
    RUN_TEST(test_on_error_is_for_programs);
    RUN_TEST(test_on_clear_comes_with_run_and_new);
    RUN_TEST(test_mm_end_comes_with_the_end_only);
    return UNITY_END();
}
