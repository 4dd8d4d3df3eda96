// Numbers as PRINT and VAL have them: MMBasic's rules.
#include "basic/number_text.h"

#include <math.h>
#include <string.h>

#include <unity.h>

void setUp(void) {}
void tearDown(void) {}

static char text[NUMBER_TEXT_SIZE];

static const char *printed(double number) {
    size_t length = number_text_float(text, number);
    TEST_ASSERT_EQUAL_size_t(strlen(text), length);
    return text;
}

static void test_print(void) {
    TEST_ASSERT_EQUAL_STRING("0.3333333333", printed(1.0 / 3.0));
    TEST_ASSERT_EQUAL_STRING("0", printed(-0.0));
    TEST_ASSERT_EQUAL_STRING("-2.5", printed(-2.5));
    TEST_ASSERT_EQUAL_STRING("1e+06", printed(1e6));
    TEST_ASSERT_EQUAL_STRING("999999.5", printed(999999.5));
    TEST_ASSERT_EQUAL_STRING("1000000", printed(999999.9999999));
    TEST_ASSERT_EQUAL_STRING("0.0001", printed(0.0001));
    TEST_ASSERT_EQUAL_STRING("9.9e-05", printed(0.000099));
    TEST_ASSERT_EQUAL_STRING("1.797693135e+308", printed(1.7976931348623157e308));
    TEST_ASSERT_EQUAL_STRING("4.940656458e-324", printed(4.9406564584124654e-324));
    TEST_ASSERT_EQUAL_STRING("inf", printed(HUGE_VAL));
}

static void check_parse(const char *source, size_t used, double number) {
    value_t value;
    TEST_ASSERT_EQUAL_size_t_MESSAGE(used, number_text_parse(source, strlen(source), &value),
                                     source);
    double got = value.type == VALUE_INTEGER ? (double)value.integer : value.number;
    TEST_ASSERT_TRUE_MESSAGE(got == number, source);
}

static void test_parse(void) {
    check_parse("12", 2, 12);
    check_parse("  -12.5mm", 7, -12.5);
    check_parse("+3", 2, 3);
    check_parse("&hfF", 4, 255);
    check_parse("0x1G", 3, 1);
    check_parse("-&B11", 5, -3);
    check_parse("1e5", 3, 1e5);
    check_parse("1e", 1, 1);
    check_parse("abc", 0, 0);
    check_parse("", 0, 0);
    check_parse("-", 0, 0);
    check_parse("&H", 0, 0);
    check_parse(".5", 2, 0.5);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_print);
    RUN_TEST(test_parse);
    return UNITY_END();
}
