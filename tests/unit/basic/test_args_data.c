// Arguments that stand for several numbers: data to be sent, and variables to be written into.
#include <stdio.h>
#include <string.h>

#include <unity.h>

#include "board.h"

#define MOST 300

static int64_t numbers[MOST];
static size_t number_count;
static unsigned runs;

static err_t send(const basic_arg_t *args, size_t count) {
    runs++;
    TEST_ASSERT_EQUAL_size_t(2, count);
    number_count = (size_t)args[1].integer;
    TEST_ASSERT_LESS_OR_EQUAL(MOST, number_count);
    for (size_t i = 0; i < number_count; i++) {
        numbers[i] = basic_data_number(&args[1], i);
    }
    return ERR_OK;
}

// Counts down into the whole variable.
static err_t fetch(const basic_arg_t *args, size_t count) {
    (void)count;
    runs++;
    for (int64_t i = 0; i < args[1].integer && i < args[0].integer; i++) {
        basic_store_number(&args[1], (size_t)i, 90 - i);
    }
    return ERR_OK;
}

static const basic_arg_spec_t send_args[] = {
    {.name = "first", .kind = BASIC_ARG_INTEGER},
    {.name = "data", .kind = BASIC_ARG_DATA},
};
static const basic_arg_spec_t fetch_args[] = {
    {.name = "most", .kind = BASIC_ARG_INTEGER},
    {.name = "target", .kind = BASIC_ARG_STORE},
};
static const basic_command_t commands[] = {
    {"SEND", send_args, 2, send, "Sends"},
    {"FETCH", fetch_args, 2, fetch, "Fetches"},
};

void setUp(void) {
    board_reset();
    board_start(commands, COUNT_OF_ARRAY(commands), NULL, 0);
    number_count = 0;
    runs = 0;
}
void tearDown(void) {}

static void obey(const char *line) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", board_answer(line), line);
}

static void reject(const char *line, const char *error) {
    char expected[300];
    snprintf(expected, sizeof expected, "Error : %s\r\n", error);
    runs = 0;
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, board_answer(line), line);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, runs, line);
}

static void sends(const char *line, size_t count, const int64_t *expected) {
    number_count = 0;
    obey(line);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(count, number_count, line);
    for (size_t i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_INT64_MESSAGE(expected[i], numbers[i], line);
    }
}

static void test_numbers(void) {
    sends("SEND 0, 7", 1, (int64_t[]){7});
    obey("x = 2.5: i% = -3: DIM a(3) = (4, 5, 6, 7)");
    sends("SEND 0, x, i%, a(2), x * 2, 1e300, -1e300", 6,
          (int64_t[]){3, -3, 6, 5, INT64_MAX, INT64_MIN});
}

static void test_strings_and_arrays(void) {
    obey("s$ = \"A\" + CHR$(200): DIM a%(2) = (1, -2, 3): DIM f(1, 1)");
    sends("SEND 0, s$", 2, (int64_t[]){65, 200});
    sends("SEND 0, s$ + \"!\"", 3, (int64_t[]){65, 200, 33});
    sends("SEND 0, \"\"", 0, NULL);
    sends("SEND 0, a%()", 3, (int64_t[]){1, -2, 3});
    sends("SEND 0, f()", 4, (int64_t[]){0, 0, 0, 0});
}

static void test_as_many_as_a_line_holds(void) {
    char line[700] = "SEND 0";
    for (unsigned i = 0; i < 110; i++) {
        strcat(line, ",9");
    }
    obey(line);
    TEST_ASSERT_EQUAL_size_t(110, number_count);
}

static void test_what_is_no_data(void) {
    obey("DIM s$(2): DIM a(2)");
    reject("SEND 0", "Missing data");
    reject("SEND 0,", "Missing data");
    reject("SEND 0, 1,, 2", "Missing data");
    reject("SEND 0, 1, \"a\"", "data: expected numbers, one string or one array");
    reject("SEND 0, a(), 1", "data: expected numbers, one string or one array");
    reject("SEND 0, s$()", "data: expected an array of numbers");
    reject("SEND 0, nowhere()", "NOWHERE is not declared");
}

static void test_stores(void) {
    obey("DIM a(2), i%(1), s$(1), t$ LENGTH 5");
    obey("FETCH 99, x: FETCH 99, i%(1): FETCH 99, a(): FETCH 3, s$(1): FETCH 99, t$");
    TEST_ASSERT_EQUAL_STRING(" 90 0 90 90 89 88\r\n",
                             board_answer("PRINT x; i%(0); i%(1); a(0); a(1); a(2)"));
    TEST_ASSERT_EQUAL_STRING("ZYX ZYXWV 5\r\n", board_answer("PRINT s$(1); \" \"; t$; LEN(t$)"));
}

static void test_what_cannot_be_stored_into(void) {
    obey("DIM s$(2): CONST c = 4");
    reject("FETCH 1, 5", "Invalid syntax");
    reject("FETCH 1, x + 1", "Invalid syntax");
    reject("FETCH 1, c", "Cannot change a constant");
    reject("FETCH 1, s$()", "target: expected an array of numbers");
    reject("FETCH 1", "Missing target");
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_numbers);
    RUN_TEST(test_strings_and_arrays);
    RUN_TEST(test_as_many_as_a_line_holds);
    RUN_TEST(test_what_is_no_data);
    RUN_TEST(test_stores);
    RUN_TEST(test_what_cannot_be_stored_into);
    return UNITY_END();
}
