// CPU RESTART and WATCHDOG: when the board is restarted and when it is not.
#include <string.h>

#include <unity.h>

#include "board.h"

static const char *typed;

void setUp(void) {
    board_reset();
    board_start(NULL, 0, NULL, 0);
}
void tearDown(void) {}

static void type_it(void) {
    board_session(typed);
}

static int restarts(const char *text) {
    typed = text;
    return board_restarts(type_it);
}

static void test_a_program_that_does_not_call_is_restarted_in_time(void) {
    TEST_ASSERT_EQUAL_INT(2, restarts("WATCHDOG 50: DO: LOOP\r"));
    TEST_ASSERT_UINT64_WITHIN(1000, 50000, board.time_us);
}

static void test_a_pause_is_no_way_out(void) {
    TEST_ASSERT_EQUAL_INT(2, restarts("WATCHDOG 50: PAUSE 10000\r"));
    TEST_ASSERT_UINT64_WITHIN(2000, 50000, board.time_us);
}

static void test_waiting_for_input_is_no_way_out(void) {
    board_type_at(200000, "5\r");
    TEST_ASSERT_EQUAL_INT(2, restarts("WATCHDOG 50: INPUT a\r"));
}

static void test_the_prompt_is_safe(void) {
    board_type_at(200000, "PRINT 1\r");
    TEST_ASSERT_EQUAL_INT(0, restarts("WATCHDOG 50: PAUSE 40\r"));
}

static void test_restart(void) {
    TEST_ASSERT_EQUAL_INT(1, restarts("PRINT 7: CPU RESTART\r"));
    TEST_ASSERT_NOT_NULL(strstr(board_shown(), "\r\n 7\r\n"));
}

static void test_boot_loader(void) {
    TEST_ASSERT_EQUAL_INT(3, restarts("CPU RESTART BOOTSEL\r"));
    TEST_ASSERT_EQUAL_INT(3, restarts("update firmware\r"));
}

static void test_no_restart_while_the_product_is_busy(void) {
    static const char *const lines[] = {"CPU RESTART\r", "CPU RESTART BOOTSEL\r",
                                        "UPDATE FIRMWARE\r"};
    board.busy = true;
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(0, restarts(lines[i]));
    }
    TEST_ASSERT_NOT_NULL(strstr(board_session("CPU RESTART\r"), "Error : Busy\r\n"));
    TEST_ASSERT_EQUAL_INT(2, restarts("WATCHDOG 5: DO: LOOP\r")); // who else should help
}

static void test_mm_watchdog(void) {
    TEST_ASSERT_NOT_NULL(strstr(board_session("PRINT MM.WATCHDOG\r"), "\r\n 0\r\n"));
    board.start_reason = HAL_START_WATCHDOG;
    TEST_ASSERT_NOT_NULL(strstr(board_session("PRINT MM.WATCHDOG\r"), "\r\n 1\r\n"));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_program_that_does_not_call_is_restarted_in_time);
    RUN_TEST(test_a_pause_is_no_way_out);
    RUN_TEST(test_waiting_for_input_is_no_way_out);
    RUN_TEST(test_the_prompt_is_safe);
    RUN_TEST(test_restart);
    RUN_TEST(test_boot_loader);
    RUN_TEST(test_no_restart_while_the_product_is_busy);
    RUN_TEST(test_mm_watchdog);
    return UNITY_END();
}
