// Rows of one name told apart by a word, assignments to functions, and what a bare pin number
// means.
#include <stdio.h>
#include <string.h>

#include <unity.h>

#include "board.h"
#include "hal/pins.h"

static char seen[200];

static err_t note(const char *row, const basic_arg_t *args, size_t count) {
    size_t used = (size_t)snprintf(seen, sizeof seen, "%s", row);
    for (size_t i = 0; i < count; i++) {
        used += args[i].given
                    ? (size_t)snprintf(seen + used, sizeof seen - used, " %d", (int)args[i].integer)
                    : (size_t)snprintf(seen + used, sizeof seen - used, " -");
    }
    return ERR_OK;
}

static err_t set_lamp(const basic_arg_t *args, size_t count) {
    return note("lamp", args, count);
}

static err_t set_off(const basic_arg_t *args, size_t count) {
    return note("off", args, count);
}

static err_t set_horn(const basic_arg_t *args, size_t count) {
    return note("horn", args, count);
}

static err_t drive(const basic_arg_t *args, size_t count) {
    return note("drive", args, count);
}

static err_t drive_off(const basic_arg_t *args, size_t count) {
    return note("drive off", args, count);
}

static err_t assign(const basic_arg_t *args, size_t count) {
    return note("assign", args, count);
}

static err_t refuse(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return err_raise(ERR_ARGUMENT, "%s", "door open");
}

static err_t read_level(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    result->integer = args[0].integer;
    return ERR_OK;
}

#define PIN {.name = "pin", .kind = BASIC_ARG_PIN}
#define BOARD_PIN {.name = "pin", .kind = BASIC_ARG_PIN, .flags = BASIC_ARG_BOARD_NUMBER}
#define USE(words)                                                                                 \
    {.name = "use", .kind = BASIC_ARG_CHOICE, .flags = BASIC_ARG_SELECTS, .choices = words}
#define NUMBER(text) {.name = text, .kind = BASIC_ARG_INTEGER}

static const basic_arg_spec_t lamp_args[] = {BOARD_PIN, USE("LAMP|TORCH"), NUMBER("watts")};
static const basic_arg_spec_t off_args[] = {BOARD_PIN, USE("OFF")};
static const basic_arg_spec_t horn_args[] = {BOARD_PIN, BOARD_PIN, USE("HORN")};
static const basic_arg_spec_t drive_args[] = {NUMBER("motor"), NUMBER("speed")};
static const basic_arg_spec_t drive_off_args[] = {NUMBER("motor"), USE("OFF")};
static const basic_arg_spec_t step_args[] = {PIN};
static const basic_arg_spec_t level_args[] = {NUMBER("value"), BOARD_PIN};
static const basic_arg_spec_t group_args[] = {
    NUMBER("value"),
    {.name = "start", .kind = BASIC_ARG_INTEGER, .flags = BASIC_ARG_REPEAT},
    NUMBER("bits"),
};
static const basic_arg_spec_t read_args[] = {BOARD_PIN};

static const basic_command_t commands[] = {
    {"SET", lamp_args, 3, set_lamp, NULL},         {"SET", off_args, 2, set_off, NULL},
    {"SET", horn_args, 3, set_horn, NULL},         {"DRIVE", drive_args, 2, drive, NULL},
    {"DRIVE", drive_off_args, 2, drive_off, NULL}, {"STEP", step_args, 1, drive, NULL},
};
static const basic_function_t functions[] = {
    {"LEVEL", NULL, read_args, 1, read_level, NULL},
};
static const basic_assignment_t assignments[] = {
    {"LEVEL", level_args, 2, assign, "Sets it"},
    {"GROUP", group_args, 3, assign, NULL},
    {"DOOR", level_args, 2, refuse, NULL},
};

void setUp(void) {
    board_reset();
    board_assignments(assignments, COUNT_OF_ARRAY(assignments));
    board_start(commands, COUNT_OF_ARRAY(commands), functions, COUNT_OF_ARRAY(functions));
    seen[0] = '\0';
}
void tearDown(void) {}

// What one line at the prompt shows, without its echo.
static void accept(const char *line, const char *expected) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", board_answer(line), line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, seen, line);
}

static void reject(const char *line, const char *error) {
    char expected[300];
    snprintf(expected, sizeof expected, "Error : %s\r\n", error);
    seen[0] = '\0';
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, board_answer(line), line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", seen, line);
}

static void test_a_word_selects_the_row(void) {
    accept("SET GP2, lamp, 40", "lamp 2 0 40");
    accept("set gp3,TORCH,1", "lamp 3 1 1");
    accept("SET GP2, OFF", "off 2 0");
    accept("SET GP2, GP3, HORN", "horn 2 3 0");
    accept("SET \"GP2\", OFF", "off 2 0");
    accept("IF 1 THEN SET GP2, OFF ELSE SET GP2, LAMP, 1", "off 2 0");
    accept("SET GP2, LAMP, LEN(\"a,b\")", "lamp 2 0 3");
}

static void test_a_row_without_such_a_word_takes_the_rest(void) {
    accept("DRIVE 1, 500", "drive 1 500");
    accept("DRIVE 1, OFF", "drive off 1 0");
    accept("DRIVE (1 + LEN(\"x,OFF\")), 7", "drive 6 7");
    TEST_ASSERT_EQUAL_STRING("", board_answer("speed = 9"));
    accept("DRIVE 1, speed", "drive 1 9");
}

static void test_no_row_selected(void) {
    reject("SET GP2, BELL", "use: BELL is invalid (valid is LAMP, TORCH, OFF, HORN)");
    reject("SET GP2, 5", "use: 5 is invalid (valid is LAMP, TORCH, OFF, HORN)");
    reject("SET GP2", "Missing use");
    reject("SET", "Missing use");
    reject("SET GP2,,5", "Missing use");
    reject("SET GP2, OFF, 3", "Too many arguments");
    reject("SET GP2, LAMP", "Missing watts");
}

static void test_assignments(void) {
    accept("LEVEL(GP4) = 3", "assign 3 4");
    accept("LET level(GP4) = -1", "assign -1 4");
    accept("LEVEL(\"GP\" + \"5\") = LEVEL(GP7) * 2", "assign 14 5");
    accept("GROUP(1, 2, 3, 4) = 5", "assign 5 1 2 3 4");
    accept("GROUP() = 5", "assign 5");
    accept("IF 1 THEN LEVEL(GP4) = 1 ELSE LEVEL(GP4) = 0", "assign 1 4");
    reject("LEVEL(GP4) = \"x\"", "value: expected a number");
    reject("LEVEL() = 1", "Missing pin");
    reject("LEVEL(GP4, 1) = 1", "Too many arguments");
    reject("LEVEL(GP4) =", "Invalid syntax");
    reject("GROUP(1) = 2", "Missing bits");
    reject("DOOR(GP4) = 1", "door open");
    TEST_ASSERT_NOT_NULL(strstr(board_answer("HELP LEVEL"), "LEVEL(pin) = value"));
}

static void test_bare_pin_numbers(void) {
    accept("SET 4, OFF", "off 2 0"); // pin 4 of the board is GP2
    accept("STEP 4", "drive 4");
    accept("LEVEL(7) = 1", "assign 1 5");
    TEST_ASSERT_EQUAL_STRING(" 5\r\n", board_answer("PRINT LEVEL(7)"));
    accept("a = 4 : SET a, OFF", "off 2 0");
    accept("SET 4.4, OFF", "off 2 0");
    reject("SET 3, OFF", "Invalid pin 3 (ground)");
    reject("SET 0, OFF", "Invalid pin 0 (valid is 1 to 40)");
    reject("SET 41, OFF", "Invalid pin 41 (valid is 1 to 40)");
    reject("SET -1, OFF", "Invalid pin -1 (valid is 1 to 40)");
    reject("SET 1e30, OFF", "Invalid pin 1e+30 (valid is 1 to 40)");
    reject("SET GP23, OFF", "Invalid pin GP23 (used by the board itself)");
    TEST_ASSERT_EQUAL(ERR_OK, basic_set_option(BASIC_PIN_NUMBERS, BASIC_PIN_NUMBERS_GPIO));
    accept("SET 4, OFF", "off 4 0");
    accept("STEP 4", "drive 4");
    TEST_ASSERT_EQUAL(ERR_OK, basic_set_option(BASIC_PIN_NUMBERS, BASIC_PIN_NUMBERS_BOARD));
    accept("SET 4, OFF", "off 2 0");
    accept("STEP 4", "drive 2");
    accept("STEP GP4", "drive 4");
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_word_selects_the_row);
    RUN_TEST(test_a_row_without_such_a_word_takes_the_rest);
    RUN_TEST(test_no_row_selected);
    RUN_TEST(test_assignments);
    RUN_TEST(test_bare_pin_numbers);
    return UNITY_END();
}
