// Arguments of command rows: every kind, blanks, defaults, ranges, groups, and the error texts.
#include <stdio.h>
#include <string.h>

#include <unity.h>

#include "board.h"
#include "hal/pins.h"

static basic_arg_t got[BASIC_ARGS_MAX];
static char texts[BASIC_ARGS_MAX][300];
static size_t got_count;
static unsigned runs;

static err_t remember(const basic_arg_t *args, size_t count) {
    got_count = count;
    runs++;
    for (size_t i = 0; i < count; i++) {
        got[i] = args[i];
        snprintf(texts[i], sizeof texts[i], "%.*s", (int)args[i].text.length, args[i].text.text);
    }
    return ERR_OK;
}

static err_t refuse(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return err_raise(ERR_ARGUMENT, "%s", "door open");
}

static const basic_arg_spec_t axis_args[] = {
    {.name = "axis", .kind = BASIC_ARG_CHOICE, .choices = "X|Y|Z|A"},
    {.name = "step_pin", .kind = BASIC_ARG_PIN},
    {.name = "enable_pin", .kind = BASIC_ARG_PIN, .flags = BASIC_ARG_OPTIONAL},
    {.name = "invert", .kind = BASIC_ARG_INTEGER, .flags = BASIC_ARG_DEFAULT, .min = 0, .max = 1},
    {.name = "steps",
     .kind = BASIC_ARG_NUMBER,
     .flags = BASIC_ARG_DEFAULT | BASIC_ARG_ABOVE_MIN,
     .min = 0,
     .max = 100000,
     .fallback = 200,
     .unit = "steps/mm",
     .help = "steps for one unit"},
};
static const basic_arg_spec_t raw_args[] = {{.name = "words", .kind = BASIC_ARG_RAW}};
static const basic_arg_spec_t text_args[] = {{.name = "line", .kind = BASIC_ARG_TEXT}};
static const basic_arg_spec_t group_args[] = {
    {.name = "code", .kind = BASIC_ARG_WORD},
    {.name = "letter", .kind = BASIC_ARG_WORD, .flags = BASIC_ARG_REPEAT},
    {.name = "value", .kind = BASIC_ARG_NUMBER},
};
static const basic_arg_spec_t chip_args[] = {
    {.name = "chip", .kind = BASIC_ARG_CHOICE, .choices = "2208|2209"}};
static const basic_arg_spec_t way_args[] = {
    {.name = "way", .kind = BASIC_ARG_NUMBER, .min = -100, .max = 100, .choices = "+|-|HOME"},
    {.name = "speed", .kind = BASIC_ARG_NUMBER, .flags = BASIC_ARG_OPTIONAL},
};
static const basic_arg_spec_t register_args[] = {
    {.name = "register",
     .kind = BASIC_ARG_WORD,
     .flags = BASIC_ARG_OR_NUMBER,
     .min = 0,
     .max = 127},
};
static const basic_arg_spec_t wire_args[] = {
    {.name = "pin", .kind = BASIC_ARG_PIN},
    {.name = "speed", .kind = BASIC_ARG_INTEGER},
};
static const basic_arg_spec_t free_args[] = {{.name = "any", .kind = BASIC_ARG_INTEGER}};

static const basic_command_t commands[] = {
    {"MOTOR", free_args, 1, remember, "Sets it"},
    {"DRIVE AXIS", axis_args, 5, remember, "Configures an axis"},
    {"DRIVE GC", raw_args, 1, remember, NULL},
    {"DRIVE GS", text_args, 1, remember, NULL},
    {"DRIVE GCODE", group_args, 3, remember, NULL},
    {"DRIVE RUN", NULL, 0, remember, NULL},
    {"DRIVE RUN AGAIN", NULL, 0, refuse, NULL},
    {"DRIVE CHIP", chip_args, 1, remember, NULL},
    {"DRIVE WAY", way_args, 2, remember, NULL},
    {"DRIVE READ", register_args, 1, remember, NULL},
    {"WIRE", wire_args, 2, remember, NULL},
    {"WIRE CLOSE", NULL, 0, remember, NULL},
};

static err_t position(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    result->type = BASIC_FLOAT;
    result->number = (double)args[0].integer + 0.5;
    return ERR_OK;
}

static err_t active(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    result->integer = -1;
    return ERR_OK;
}

static err_t name(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    result->type = BASIC_STRING;
    result->text = (basic_text_t){"mill", 4};
    return ERR_OK;
}

static const basic_function_t functions[] = {
    {"PEEK", "ACTIVE", NULL, 0, active, NULL},
    {"PEEK", "DRIVE", axis_args, 1, position, NULL},
    {"NAME$", NULL, NULL, 0, name, NULL},
};

void setUp(void) {
    board_reset();
    board_start(commands, COUNT_OF_ARRAY(commands), functions, COUNT_OF_ARRAY(functions));
    got_count = 0;
    runs = 0;
}
void tearDown(void) {}

static void accept(const char *line) {
    runs = 0;
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", board_answer(line), line);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, runs, line);
}

static void reject(const char *line, const char *error) {
    char expected[300];
    snprintf(expected, sizeof expected, "Error : %s\r\n", error);
    runs = 0;
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, board_answer(line), line);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, runs, line);
}

static void test_all_arguments(void) {
    accept("DRIVE AXIS Y, GP3, GP4, 1, 80.5");
    TEST_ASSERT_EQUAL_size_t(5, got_count);
    TEST_ASSERT_EQUAL_INT64(1, got[0].integer);
    TEST_ASSERT_EQUAL_STRING("Y", texts[0]);
    TEST_ASSERT_EQUAL_INT64(3, got[1].integer);
    TEST_ASSERT_EQUAL_INT64(4, got[2].integer);
    TEST_ASSERT_EQUAL_INT64(1, got[3].integer);
    TEST_ASSERT_TRUE(got[4].number == 80.5 && got[4].given);
}

static void test_blanks_and_defaults(void) {
    accept("drive axis x,gp0,,,");
    TEST_ASSERT_FALSE(got[2].given);
    TEST_ASSERT_EQUAL_INT64(PINS_NONE, got[2].integer);
    TEST_ASSERT_FALSE(got[4].given);
    TEST_ASSERT_TRUE(got[4].number == 200.0);
    accept("drive axis x,gp0");
    TEST_ASSERT_EQUAL_size_t(5, got_count);
    TEST_ASSERT_FALSE(got[4].given);
}

static void test_missing_and_too_many(void) {
    reject("DRIVE AXIS", "Missing axis");
    reject("DRIVE AXIS X", "Missing step_pin");
    reject("DRIVE AXIS X,,GP3", "Missing step_pin");
    reject("DRIVE AXIS X,GP1,GP2,0,80,5", "Too many arguments");
    reject("DRIVE RUN 5", "Too many arguments");
    reject("MOTOR", "Missing any");
}

static void test_ranges(void) {
    reject("DRIVE AXIS X,GP1,,,-5", "steps: -5 is invalid (valid is above 0 to 100000)");
    reject("DRIVE AXIS X,GP1,,,0", "steps: 0 is invalid (valid is above 0 to 100000)");
    reject("DRIVE AXIS X,GP1,,,100000.5",
           "steps: 100000.5 is invalid (valid is above 0 to 100000)");
    accept("DRIVE AXIS X,GP1,,,100000");
    reject("DRIVE AXIS X,GP1,,2", "invert: 2 is invalid (valid is 0 to 1)");
    reject("DRIVE AXIS X,GP1,,1.5", "invert: 1.5 is invalid (valid is 0 to 1)");
    accept("DRIVE AXIS X,GP1,,1.4");
    TEST_ASSERT_EQUAL_INT64(1, got[3].integer);
    reject("MOTOR 1e30", "any: 1e+30 is invalid (valid is any number)");
    accept("MOTOR -9000000000");
    TEST_ASSERT_EQUAL_INT64(-9000000000, got[0].integer);
}

static void test_wrong_kinds(void) {
    reject("DRIVE AXIS X,GP1,,\"a\"", "invert: expected a number");
    reject("DRIVE GS 5", "line: expected a string");
    reject("MOTOR 1+", "Invalid syntax");
    reject("MOTOR 1 2", "Invalid syntax");
}

static void test_choices(void) {
    reject("DRIVE AXIS Q,GP1", "axis: Q is invalid (valid is X, Y, Z, A)");
    accept("DRIVE AXIS \"z\",GP1");
    TEST_ASSERT_EQUAL_INT64(2, got[0].integer);
    TEST_ASSERT_EQUAL_STRING("", board_answer("w$=\"a\""));
    accept("DRIVE AXIS w$,GP1");
    TEST_ASSERT_EQUAL_INT64(3, got[0].integer);
    TEST_ASSERT_EQUAL_STRING("", board_answer("x$=\"Y\""));
    accept("DRIVE AXIS X,GP1"); // a choice wins over a variable of that name
    TEST_ASSERT_EQUAL_INT64(0, got[0].integer);
    accept("DRIVE CHIP 2209");
    TEST_ASSERT_EQUAL_INT64(1, got[0].integer);
    TEST_ASSERT_EQUAL_STRING("", board_answer("c=2208"));
    accept("DRIVE CHIP c");
    TEST_ASSERT_EQUAL_INT64(0, got[0].integer);
    reject("DRIVE CHIP 2130", "chip: 2130 is invalid (valid is 2208, 2209)");
}

static void check_way(const char *line, double number, const char *word, int64_t index) {
    accept(line);
    TEST_ASSERT_TRUE(got[0].number == number);
    TEST_ASSERT_EQUAL_STRING(word, texts[0]);
    TEST_ASSERT_EQUAL_INT64(index, got[0].integer);
}

static void test_numbers_or_words(void) {
    check_way("DRIVE WAY -5", -5, "", 0);
    check_way("DRIVE WAY +5,7", 5, "", 0);
    check_way("DRIVE WAY -(2+1)*2", -6, "", 0);
    check_way("DRIVE WAY +", 0, "+", 0);
    check_way("DRIVE WAY -", 1, "-", 1);
    check_way("DRIVE WAY - ' comment", 1, "-", 1);
    check_way("drive way -, 7", 1, "-", 1);
    TEST_ASSERT_TRUE(got[1].number == 7);
    check_way("DRIVE WAY home", 2, "HOME", 2);
    TEST_ASSERT_EQUAL_STRING("", board_answer("d$=\"-\":home=7"));
    check_way("DRIVE WAY d$", 1, "-", 1);
    check_way("DRIVE WAY home*2", 14, "", 0); // alone it is the word
    check_way("IF 1 THEN DRIVE WAY - ELSE MOTOR 1", 1, "-", 1);
    reject("DRIVE WAY 101", "way: 101 is invalid (valid is -100 to 100, +, -, HOME)");
    reject("DRIVE WAY \"up\"", "way: up is invalid (valid is -100 to 100, +, -, HOME)");
    reject("DRIVE WAY", "Missing way");
    reject("DRIVE WAY +,+", "Invalid syntax");
    reject("DRIVE WAY --", "Invalid syntax");
    TEST_ASSERT_NOT_NULL(strstr(board_answer("HELP DRIVE WAY"), "-100 to 100, +, -, HOME"));
}

static void check_register(const char *line, int64_t number, const char *word) {
    accept(line);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(number, got[0].integer, line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(word, texts[0], line);
}

static void test_words_or_numbers(void) {
    check_register("DRIVE READ &H6C", 0x6C, "");
    check_register("DRIVE READ 100+8", 108, "");
    check_register("DRIVE READ GCONF", 0, "GCONF");
    check_register("DRIVE READ \"IOIN\"", 0, "IOIN");
    TEST_ASSERT_EQUAL_STRING("", board_answer("SG=5:r$=\"CS\""));
    check_register("DRIVE READ r$", 0, "CS");
    check_register("DRIVE READ SG", 0, "SG"); // a number of this name does not matter
    check_register("DRIVE READ (SG)", 5, "");
    reject("DRIVE READ 128", "register: 128 is invalid (valid is 0 to 127)");
    TEST_ASSERT_NOT_NULL(strstr(board_answer("HELP DRIVE READ"), "a word, a string or a number"));
}

static void test_pins(void) {
    accept("DRIVE AXIS X,\"gp12\"");
    TEST_ASSERT_EQUAL_INT64(12, got[1].integer);
    accept("DRIVE AXIS X,16");
    TEST_ASSERT_EQUAL_INT64(16, got[1].integer);
    accept("DRIVE AXIS X,8+1");
    TEST_ASSERT_EQUAL_INT64(9, got[1].integer);
    TEST_ASSERT_EQUAL_STRING("", board_answer("p$=\"GP7\""));
    accept("DRIVE AXIS X,p$");
    TEST_ASSERT_EQUAL_INT64(7, got[1].integer);
    accept("DRIVE AXIS X,0"); // a pin that must be given: GPIO 0
    TEST_ASSERT_EQUAL_INT64(0, got[1].integer);
    accept("DRIVE AXIS X,GP1,0"); // optional: a plain 0 means none
    TEST_ASSERT_EQUAL_INT64(PINS_NONE, got[2].integer);
    accept("DRIVE AXIS X,GP1,GP0");
    TEST_ASSERT_EQUAL_INT64(0, got[2].integer);
    accept("DRIVE AXIS X,GP1,1-1"); // not a plain 0
    TEST_ASSERT_EQUAL_INT64(0, got[2].integer);
    reject("DRIVE AXIS X,GP99", "Invalid pin GP99 for step_pin (valid is GP0 to GP28)");
    reject("DRIVE AXIS X,GP23", "Invalid pin GP23 for step_pin (used by the board itself)");
    reject("DRIVE AXIS X,-3", "Invalid pin -3 for step_pin (valid is GP0 to GP28)");
    reject("DRIVE AXIS X,\"X\"", "Invalid pin X for step_pin (valid is GP0 to GP28)");
    reject("DRIVE AXIS X,1e18", "Invalid pin 1e+18 for step_pin (valid is GP0 to GP28)");
}

static void test_raw(void) {
    accept("DRIVE GC G1 X10 ' to: the edge");
    TEST_ASSERT_EQUAL_STRING("G1 X10 ' to: the edge", texts[0]);
    accept("drive gc G1 (a:b) X10 ; c:d");
    TEST_ASSERT_EQUAL_STRING("G1 (a:b) X10 ; c:d", texts[0]);
    accept("DRIVE GC G1X10Y-5:a=1");
    TEST_ASSERT_EQUAL_STRING("G1X10Y-5", texts[0]);
    accept("IF 1 THEN DRIVE GC G1 X1 ELSE DRIVE GC G1 X2");
    TEST_ASSERT_EQUAL_STRING("G1 X1", texts[0]);
    accept("DRIVE GC");
    TEST_ASSERT_EQUAL_STRING("", texts[0]);
}

static void test_groups(void) {
    accept("DRIVE GCODE G1, X, 10, Y, 2*4");
    TEST_ASSERT_EQUAL_size_t(5, got_count);
    TEST_ASSERT_EQUAL_STRING("G1", texts[0]);
    TEST_ASSERT_EQUAL_STRING("Y", texts[3]);
    TEST_ASSERT_TRUE(got[4].number == 8.0);
    accept("DRIVE GCODE \"\"");
    TEST_ASSERT_EQUAL_size_t(1, got_count);
    reject("DRIVE GCODE G1, X", "Missing value");
    TEST_ASSERT_EQUAL_STRING("", board_answer("g$=\"G0\""));
    accept("DRIVE GCODE g$, X, 1");
    TEST_ASSERT_EQUAL_STRING("G0", texts[0]);
    reject("DRIVE GCODE G1,X,1,X,2,X,3,X,4,X,5,X,6,X,7,X,8,X,9,X,1,X,2,X,3", "Too many arguments");
}

static void test_names(void) {
    accept("DRIVE RUN");
    accept("drive   run");
    reject("DRIVE RUN AGAIN", "door open");
    reject("DRIVE", "Unknown DRIVE subcommand");
    reject("drive runs", "Unknown DRIVE subcommand");
    reject("DRIVES RUN", "Unknown command");
    accept("MOTOR 1");
}

// A word that cannot be the first argument was meant as a part of the name.
static void test_unknown_words(void) {
    reject("WIRE CLOES", "Unknown WIRE subcommand");
    reject("WIRE SPEED 5", "Unknown WIRE subcommand");
    reject("WIRE SPEED GP3,5", "Unknown WIRE subcommand");
    reject("WIRE GP3", "Missing speed");
    reject("WIRE", "Missing pin");
    TEST_ASSERT_EQUAL_STRING("", board_answer("p=4"));
    accept("WIRE p,5");
    TEST_ASSERT_EQUAL_INT64(4, got[0].integer);
    accept("WIRE p+1,5");
    TEST_ASSERT_EQUAL_INT64(5, got[0].integer);
    accept("wire close");
}

static void test_functions(void) {
    TEST_ASSERT_EQUAL_STRING(" 1.5\r\n", board_answer("PRINT PEEK(DRIVE Y)"));
    TEST_ASSERT_EQUAL_STRING("-1\r\n", board_answer("PRINT PEEK(ACTIVE)"));
    TEST_ASSERT_EQUAL_STRING("mill!\r\n", board_answer("PRINT NAME$ + \"!\""));
    reject("PRINT PEEK(DRIVE Q)", "axis: Q is invalid (valid is X, Y, Z, A)");
    reject("PRINT PEEK(SPEED)", "Unknown PEEK subcommand");
    reject("PRINT PEEK(DRIVE)", "Missing axis");
    reject("PRINT PEEK(DRIVE X", "Invalid syntax");
}

static void test_help(void) {
    const char *help = board_answer("HELP DRIVE AXIS");
    TEST_ASSERT_NOT_NULL(
        strstr(help, "DRIVE AXIS axis, step_pin [, enable_pin] [, invert] [, steps]\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(
        help, "steps            above 0 to 100000 steps/mm, default 200: steps for one unit"));
    TEST_ASSERT_NOT_NULL(strstr(board_answer("HELP"), "DRIVE GCODE"));
    TEST_ASSERT_NOT_NULL(strstr(board_answer("HELP drive"), "DRIVE CHIP"));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_all_arguments);
    RUN_TEST(test_blanks_and_defaults);
    RUN_TEST(test_missing_and_too_many);
    RUN_TEST(test_ranges);
    RUN_TEST(test_wrong_kinds);
    RUN_TEST(test_choices);
    RUN_TEST(test_numbers_or_words);
    RUN_TEST(test_words_or_numbers);
    RUN_TEST(test_pins);
    RUN_TEST(test_raw);
    RUN_TEST(test_groups);
    RUN_TEST(test_names);
    RUN_TEST(test_unknown_words);
    RUN_TEST(test_functions);
    RUN_TEST(test_help);
    return UNITY_END();
}
