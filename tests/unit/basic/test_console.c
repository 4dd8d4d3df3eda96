// The console and the line editor: one write for a paste, notices while typing, Ctrl-C in every
// state, a terminal that does not read; and the program in flash when writing fails.
#include <string.h>

#include <unity.h>

#include "board.h"
#include "basic/console.h"

void setUp(void) {
    board_reset();
    board_start(NULL, 0, NULL, 0);
}
void tearDown(void) {}

static void test_a_pasted_line_is_echoed_in_one_write(void) {
    board.writes = 0;
    board_session("a=1234567890+1234567890\r");
    TEST_ASSERT_LESS_OR_EQUAL_UINT(3,
                                   board.writes); // prompt and echo, nothing to print, next prompt
}

static void test_ctrl_c_ends_a_loop_without_a_pause(void) {
    board_type_at(5000, "\x03");
    board_session("DO:LOOP\r");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_LESS_THAN_UINT64(10000, board.time_us);
}

static void test_ctrl_c_ends_a_pause_at_once(void) {
    board_type_at(20000, "\x03");
    const char *shown = board_session("PAUSE 100000\r");
    TEST_ASSERT_EQUAL_STRING("> PAUSE 100000\r\n> ", shown);
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_LESS_THAN_UINT64(21000, board.time_us);
}

static void test_another_break_key(void) {
    console_set_break_key('q');
    board_type_at(5000, "\x03");
    board_type_at(20000, "q");
    const char *shown = board_session("DO:PAUSE 1:LOOP\r");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(20000, board.time_us);
    TEST_ASSERT_NULL(strstr(shown, "Error"));
    shown = board_session("q\x03PRINT 2\r"); // at the prompt nothing has changed
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 2\r\n"));
    TEST_ASSERT_EQUAL_UINT(2, board.breaks);
}

static void test_no_break_key(void) {
    console_set_break_key(0);
    board_type_at(5000, "\x03");
    const char *shown = board_session("PAUSE 100:PRINT 7\r");
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 7\r\n"));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(100000, board.time_us);
}

static void test_ctrl_c_at_the_prompt_clears_the_line(void) {
    const char *shown = board_session("PRINT 1\x03PRINT 2\r");
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 2\r\n"));
    TEST_ASSERT_NULL(strstr(shown, "\r\n 1\r\n"));
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
}

static void test_ctrl_c_ends_an_input(void) {
    board_type_at(20000, "\x03");
    board_session("INPUT a\r");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
}

static void test_a_terminal_that_does_not_read_blocks_nothing_but_the_output(void) {
    board_type_at(500000, "\x03");
    board_type("DO:PRINT \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxx\":LOOP\r", 45);
    board.blocked_until_us = 600000;
    unsigned before = board.backgrounds;
    basic_prompt();
    TEST_ASSERT_GREATER_THAN_UINT(before + 100, board.backgrounds);
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(board.blocked_until_us, board.time_us);
    TEST_ASSERT_EQUAL_STRING("> PRINT 1\r\n 1\r\n> ",
                             board_session("\rPRINT 1\r") + strlen("> \r\n"));
}

static void test_a_program_that_does_not_read_its_input_can_be_stopped(void) {
    char junk[1500];
    memset(junk, 'j', sizeof junk);
    board_type("DO:PAUSE 10:LOOP\r", 17);
    board_type(junk, sizeof junk);
    board_type("\x03", 1);
    basic_prompt();
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
}

static void test_a_notice_stands_on_its_own_line(void) {
    basic_printf("a");
    basic_notice("limit %d", 5);
    basic_printf("b\n");
    board_session("");
    board_type("x", 1);
    basic_notice("plain");
    const char *shown = board_session("");
    TEST_ASSERT_NOT_NULL(strstr(shown, "plain\r\n"));
}

static err_t notice(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    basic_printf("half a line");
    basic_notice("limit reached");
    return ERR_OK;
}

static void test_a_notice_within_output(void) {
    static const basic_command_t rows[] = {{"WARN", NULL, 0, notice, NULL}};
    board_start(rows, 1, NULL, 0);
    TEST_ASSERT_EQUAL_STRING("> WARN\r\nhalf a line\r\nlimit reached\r\n> ",
                             board_session("WARN\r"));
}

// ---- Keys ---------------------------------------------------------------------------------------

static void test_a_sequence_may_come_in_pieces(void) {
    board_type("PRINT 15", 8);
    board_type_at(20000, "\x1b");
    board_type_at(60000, "[");
    board_type_at(100000, "D");
    board_type_at(500000, "7\r");
    TEST_ASSERT_NOT_NULL(strstr(board_session(""), "\r\n 175\r\n"));
}

static void test_a_sequence_in_pieces_too_far_apart_is_a_key_and_letters(void) {
    board_type("PRINT ", 6);
    board_type_at(20000, "\x1b");
    board_type_at(200000, "3\r");
    TEST_ASSERT_NOT_NULL(strstr(board_session(""), "\r\n 3\r\n"));
}

static void test_a_sequence_cut_off_leaves_the_line_end(void) {
    TEST_ASSERT_NOT_NULL(strstr(board_session("PRINT 4\x1b[1;\r"), "\r\n 4\r\n"));
}

static void test_escape_alone_is_a_key_for_inkey(void) {
    board_type_at(20000, "\x1b");
    const char *shown = board_session("DO:k$=INKEY$:LOOP UNTIL k$<>\"\":PRINT ASC(k$)\r");
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 27\r\n"));
}

// Typed by hand, a new line in the editor is indented; what comes faster is not.
static void test_the_editor_indents_what_is_typed(void) {
    board_type("EDIT\r", 5);
    board_type_at(1000000, "  a");
    board_type_at(2000000, "\r");
    board_type_at(2100000, "b");
    board_type_at(3000000, "\x11LIST\r");
    TEST_ASSERT_NOT_NULL(strstr(board_session(""), "> LIST\r\n  a\r\n  b\r\n"));
}

static void test_the_editor_leaves_a_paste_over_a_slow_line_as_it_is(void) {
    board_type("EDIT\r", 5);
    board_type_at(1000000, "  a");
    board_type_at(1000087, "\r");
    board_type_at(1000174, "b");
    board_type_at(3000000, "\x11LIST\r");
    TEST_ASSERT_NOT_NULL(strstr(board_session(""), "> LIST\r\n  a\r\nb\r\n"));
}

// ---- Characters that act at once ----------------------------------------------------------------

static void test_a_control_acts_within_a_statement_of_a_program(void) {
    board.controllable = true;
    board_type_at(5000, "\x06");
    board_session("FOR i%=1 TO 2000:NEXT\r");
    TEST_ASSERT_EQUAL_UINT(1, board.controls);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(5020, board.control_us); // a statement takes 10 us
}

static void test_a_control_acts_at_once_in_a_pause_that_goes_on(void) {
    board.controllable = true;
    board_type_at(20000, "\x06");
    const char *shown = board_session("PAUSE 100:PRINT 7\r");
    TEST_ASSERT_EQUAL_STRING("> PAUSE 100:PRINT 7\r\nheld\r\n 7\r\n> ", shown);
    TEST_ASSERT_EQUAL_UINT64(20000, board.control_us);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(100000, board.time_us);
}

static void test_a_control_leaves_the_line_being_typed_whole(void) {
    board.controllable = true;
    board_type("PRINT 12", 8);
    board_type_at(20000, "\x06");
    board_type_at(30000, "3\r");
    const char *shown = board_session("");
    TEST_ASSERT_EQUAL_STRING("> PRINT 12\r\x1b[Jheld\r\n> PRINT 123\r\n 123\r\n> ", shown);
    TEST_ASSERT_EQUAL_UINT64(20000, board.control_us);
}

static void test_a_control_overtakes_input_and_takes_none_of_it(void) {
    board.controllable = true;
    board_type_at(20000, "PRINT 1\rPRINT 2\r\x06PRINT 3\r");
    const char *shown = board_session("PAUSE 100\r");
    TEST_ASSERT_EQUAL_UINT64(20000, board.control_us);
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 1\r\n> PRINT 2\r\n 2\r\n> PRINT 3\r\n 3\r\n"));
}

static void test_a_control_acts_in_the_middle_of_a_long_output(void) {
    board.controllable = true;
    board.hold_at_write = 2;
    const char *shown = board_session("HELP\r");
    TEST_ASSERT_GREATER_THAN_UINT(4, board.writes);
    TEST_ASSERT_EQUAL_UINT(2, board.control_writes);
    TEST_ASSERT_NOT_NULL(strstr(shown, "HELP PRINT.\r\nheld\r\n> ")); // not in the middle of it
}

static void test_a_control_acts_while_the_terminal_does_not_read(void) {
    board.controllable = true;
    board.blocked_until_us = 600000;
    board_type_at(100000, "\x06");
    const char *shown = board_session("FOR i%=1 TO 40:PRINT STRING$(29,\"x\"):NEXT\r");
    TEST_ASSERT_EQUAL_UINT(1, board.controls);
    TEST_ASSERT_UINT64_WITHIN(1000, 100000, board.control_us);
    TEST_ASSERT_NOT_NULL(strstr(shown, "x\r\nheld\r\nx"));
}

static void test_a_control_with_nothing_to_act_on_is_input(void) {
    const char *shown = board_session("PRINT ASC(INKEY$)\r\x06");
    TEST_ASSERT_EQUAL_STRING("> PRINT ASC(INKEY$)\r\n 6\r\n> ", shown);
    TEST_ASSERT_EQUAL_UINT(0, board.controls);
}

static void test_a_control_of_a_script_waits_for_its_turn(void) {
    board.controllable = board.piped = true;
    const char *shown = board_session("PAUSE 100\rPRINT 1\r\x06PRINT 2\r");
    TEST_ASSERT_EQUAL_UINT(1, board.controls);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(100000, board.control_us);
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 1\r\n> \r\x1b[Jheld\r\n> PRINT 2\r\n 2\r\n"));
}

static void test_nothing_acts_in_raw_mode(void) {
    board.controllable = true;
    console_set_running(true);
    console_set_raw(true);
    board_type("\x03\x06", 2);
    console_poll();
    TEST_ASSERT_FALSE(console_break_pending());
    TEST_ASSERT_EQUAL_INT(3, console_take());
    TEST_ASSERT_EQUAL_INT(6, console_take());
    console_set_raw(false);
    board_type("\x06\x03", 2);
    console_poll();
    TEST_ASSERT_TRUE(console_break_pending());
    TEST_ASSERT_EQUAL_INT(-1, console_take());
    TEST_ASSERT_EQUAL_UINT(1, board.controls);
}

// ---- The program in flash -----------------------------------------------------------------------

#define PROGRAM(text) "AUTOSAVE\r" text "\r\x1a"

static const char *run_again(void) {
    board_start(NULL, 0, NULL, 0);
    return board_session("RUN\r");
}

static void test_the_program_survives_a_restart(void) {
    board_session(PROGRAM("PRINT 11"));
    TEST_ASSERT_NOT_NULL(strstr(run_again(), "\r\n 11\r\n"));
}

static void test_power_lost_while_writing_leaves_the_old_program(void) {
    board_session(PROGRAM("PRINT 11"));
    for (int pages = 0; pages < 2; pages++) { // the text's page, then the header's
        board.fail_program_after = pages;
        board_session(PROGRAM("PRINT 22"));
        board.fail_program_after = -1;
        TEST_ASSERT_NOT_NULL(strstr(run_again(), "\r\n 11\r\n"));
    }
}

static void test_no_change_while_motion_runs(void) {
    board_session(PROGRAM("PRINT 11"));
    board.ticking = true;
    const char *shown = board_session(PROGRAM("PRINT 22") "PRINT 33\r");
    TEST_ASSERT_NOT_NULL(strstr(shown, "Error : The flash cannot be written"));
    TEST_ASSERT_NULL(strstr(shown, "\r\n 22\r\n")); // not taken for a command
    TEST_ASSERT_NOT_NULL(strstr(shown, "\r\n 33\r\n"));
    TEST_ASSERT_NOT_NULL(strstr(board_session("NEW\r"), "Error : The flash cannot be written"));
    TEST_ASSERT_NOT_NULL(strstr(board_session("RUN\r"), "\r\n 11\r\n"));
}

// What a board shows that starts again and is then asked for 5.
static const char *boot_again(void) {
    board_start(NULL, 0, NULL, 0);
    board_shown();
    basic_boot();
    return board_session("PRINT 5\r");
}

static const char *boot_shows(void) {
    board_start(NULL, 0, NULL, 0);
    board_shown();
    basic_boot();
    return board_shown();
}

static void test_a_board_that_crashed_does_not_start_its_program(void) {
    board_session(PROGRAM("PRINT 11\rSUB MM.STARTUP\rPRINT 22\rEND SUB") "OPTION AUTORUN ON\r");
    TEST_ASSERT_EQUAL_STRING(" 22\r\n 11\r\n", boot_shows());
    board.start_reason = HAL_START_HUNG;
    TEST_ASSERT_EQUAL_STRING("MM.STARTUP and AUTORUN are skipped\r\n", boot_shows());
    TEST_ASSERT_NOT_NULL(strstr(boot_again(), "\r\n 5\r\n"));
}

static void test_without_ctrl_c_as_break_key_there_is_time_for_it_at_the_start(void) {
    board_session(PROGRAM("PRINT 11") "OPTION AUTORUN ON\rOPTION BREAK 0\r");
    uint64_t start_us = board.time_us;
    TEST_ASSERT_EQUAL_STRING("Ctrl-C now keeps the program from starting\r\n 11\r\n", boot_shows());
    TEST_ASSERT_UINT64_WITHIN(100000, 5000000, board.time_us - start_us);
    board_type_at(board.time_us + 2000000, "\x03");
    const char *shown = boot_shows();
    TEST_ASSERT_NOT_NULL(strstr(shown, "are skipped\r\n"));
    TEST_ASSERT_NULL(strstr(shown, " 11"));
}

static void test_ctrl_c_in_the_startup_keeps_the_program_from_starting(void) {
    board_session(PROGRAM("PRINT 11\rSUB MM.STARTUP\rPAUSE 1000\rEND SUB") "OPTION AUTORUN ON\r");
    TEST_ASSERT_EQUAL_STRING(" 11\r\n", boot_shows());
    board_type_at(board.time_us + 500000, "\x03");
    TEST_ASSERT_EQUAL_STRING("AUTORUN is skipped\r\n", boot_shows());
}

static void test_background_and_statements(void) {
    unsigned before = board.statements;
    board_session("FOR i%=1 TO 100:NEXT\r");
    TEST_ASSERT_EQUAL_UINT(before + 101, board.statements); // FOR and 100 times NEXT
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(101 / 16, board.backgrounds);
}

static unsigned turns_wanted; // of the background, 1 ms apart

static void want_turns(void) {
    if (turns_wanted > 0) {
        turns_wanted--;
        basic_wake_at(board.time_us + 1000);
    }
}

static void test_the_background_gets_the_turns_it_asks_for(void) {
    board_session("");
    unsigned idle = board.backgrounds;
    uint64_t begin_us = board.time_us;
    turns_wanted = 20;
    board.on_background = want_turns;
    board_session("PAUSE 50\r");
    TEST_ASSERT_EQUAL_UINT(0, turns_wanted);
    TEST_ASSERT_UINT64_WITHIN(2000, 50000, board.time_us - begin_us); // and the pause is as long
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(20, board.backgrounds - idle);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_pasted_line_is_echoed_in_one_write);
    RUN_TEST(test_ctrl_c_ends_a_loop_without_a_pause);
    RUN_TEST(test_ctrl_c_ends_a_pause_at_once);
    RUN_TEST(test_another_break_key);
    RUN_TEST(test_no_break_key);
    RUN_TEST(test_ctrl_c_at_the_prompt_clears_the_line);
    RUN_TEST(test_ctrl_c_ends_an_input);
    RUN_TEST(test_a_terminal_that_does_not_read_blocks_nothing_but_the_output);
    RUN_TEST(test_a_program_that_does_not_read_its_input_can_be_stopped);
    RUN_TEST(test_a_notice_stands_on_its_own_line);
    RUN_TEST(test_a_notice_within_output);
    RUN_TEST(test_a_sequence_may_come_in_pieces);
    RUN_TEST(test_a_sequence_in_pieces_too_far_apart_is_a_key_and_letters);
    RUN_TEST(test_a_sequence_cut_off_leaves_the_line_end);
    RUN_TEST(test_escape_alone_is_a_key_for_inkey);
    RUN_TEST(test_the_editor_indents_what_is_typed);
    RUN_TEST(test_the_editor_leaves_a_paste_over_a_slow_line_as_it_is);
    RUN_TEST(test_a_control_acts_within_a_statement_of_a_program);
    RUN_TEST(test_a_control_acts_at_once_in_a_pause_that_goes_on);
    RUN_TEST(test_a_control_leaves_the_line_being_typed_whole);
    RUN_TEST(test_a_control_overtakes_input_and_takes_none_of_it);
    RUN_TEST(test_a_control_acts_in_the_middle_of_a_long_output);
    RUN_TEST(test_a_control_acts_while_the_terminal_does_not_read);
    RUN_TEST(test_a_control_with_nothing_to_act_on_is_input);
    RUN_TEST(test_a_control_of_a_script_waits_for_its_turn);
    RUN_TEST(test_nothing_acts_in_raw_mode);
    RUN_TEST(test_the_program_survives_a_restart);
    RUN_TEST(test_power_lost_while_writing_leaves_the_old_program);
    RUN_TEST(test_no_change_while_motion_runs);
    RUN_TEST(test_a_board_that_crashed_does_not_start_its_program);
    RUN_TEST(test_without_ctrl_c_as_break_key_there_is_time_for_it_at_the_start);
    RUN_TEST(test_ctrl_c_in_the_startup_keeps_the_program_from_starting);
    RUN_TEST(test_background_and_statements);
    RUN_TEST(test_the_background_gets_the_turns_it_asks_for);
    return UNITY_END();
}
