// Error messages: the detail takes the place of the per cent sign, and nothing overflows.
#include "base/base.h"

#include <string.h>
#include <unity.h>

void setUp(void) {}
void tearDown(void) {}

static void test_text_without_slot_ignores_detail(void) {
    TEST_ASSERT_EQUAL(ERR_SYNTAX, err_raise(ERR_SYNTAX, NULL));
    TEST_ASSERT_EQUAL_STRING("Invalid syntax", err_message());
    err_raise(ERR_SYNTAX, "%s", "not wanted");
    TEST_ASSERT_EQUAL_STRING("Invalid syntax", err_message());
}

static void test_detail_takes_the_slot(void) {
    TEST_ASSERT_EQUAL(ERR_UNKNOWN_SUBCOMMAND, err_raise(ERR_UNKNOWN_SUBCOMMAND, "%s", "STEPPER"));
    TEST_ASSERT_EQUAL_STRING("Unknown STEPPER subcommand", err_message());
    err_raise(ERR_PIN_INVALID, "GP%u", 23u);
    TEST_ASSERT_EQUAL_STRING("Invalid pin GP23", err_message());
}

static void test_missing_detail_leaves_the_slot_empty(void) {
    err_raise(ERR_UNKNOWN_SUBCOMMAND, NULL);
    TEST_ASSERT_EQUAL_STRING("Unknown  subcommand", err_message());
}

static void test_detail_may_quote_the_current_message(void) {
    err_raise(ERR_PIN_INVALID, "%s", "GP99");
    err_raise(ERR_ARGUMENT, "line 3: %s", err_message());
    TEST_ASSERT_EQUAL_STRING("line 3: Invalid pin GP99", err_message());
}

static void test_percent_in_the_detail_stays(void) {
    err_raise(ERR_ARGUMENT, "%s", "100%s %n");
    TEST_ASSERT_EQUAL_STRING("100%s %n", err_message());
}

static void test_long_message_is_cut(void) {
    char detail[4 * ERR_MESSAGE_SIZE];
    memset(detail, 'x', sizeof detail - 1);
    detail[sizeof detail - 1] = '\0';
    err_raise(ERR_UNKNOWN_SUBCOMMAND, "%s", detail);
    TEST_ASSERT_EQUAL(ERR_MESSAGE_SIZE - 1, strlen(err_message()));
    TEST_ASSERT_EQUAL_STRING_LEN("Unknown xxxx", err_message(), 12);
}

static void test_what_was_kept_comes_back_whole(void) {
    err_kept_t kept;
    err_raise(ERR_PIN_INVALID, "GP%u", 23u);
    err_keep(&kept);
    err_raise(ERR_ARGUMENT, "%s", "something of the background");
    err_put_back(&kept);
    TEST_ASSERT_EQUAL(ERR_PIN_INVALID, err_code());
    TEST_ASSERT_EQUAL_STRING("Invalid pin GP23", err_message());
}

static void test_every_error_has_a_text(void) {
    for (int code = ERR_OK + 1; code < ERR_COUNT; code++) {
        err_raise((err_t)code, "%s", "detail");
        TEST_ASSERT_NOT_EQUAL(0, strlen(err_message()));
        TEST_ASSERT_NULL(strchr(err_message(), '%'));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_text_without_slot_ignores_detail);
    RUN_TEST(test_detail_takes_the_slot);
    RUN_TEST(test_missing_detail_leaves_the_slot_empty);
    RUN_TEST(test_detail_may_quote_the_current_message);
    RUN_TEST(test_percent_in_the_detail_stays);
    RUN_TEST(test_long_message_is_cut);
    RUN_TEST(test_what_was_kept_comes_back_whole);
    RUN_TEST(test_every_error_has_a_text);
    return UNITY_END();
}
