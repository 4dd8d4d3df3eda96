// Numbers as text: MMBasic's rules, and agreement with the C library where it rounds the same way.
#include "basic/number_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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

static void test_integers(void) {
    number_text_integer(text, INT64_MIN);
    TEST_ASSERT_EQUAL_STRING("-9223372036854775808", text);
    number_text_integer(text, 0);
    TEST_ASSERT_EQUAL_STRING("0", text);
}

static void test_ties_go_away_from_zero(void) {
    number_text_fixed(text, 0.5, 0);
    TEST_ASSERT_EQUAL_STRING("1", text);
    number_text_fixed(text, -2.5, 0);
    TEST_ASSERT_EQUAL_STRING("-3", text);
    number_text_fixed(text, 0.125, 2);
    TEST_ASSERT_EQUAL_STRING("0.13", text);
}

static void test_long_fixed(void) {
    number_text_fixed(text, 1e20, 2);
    TEST_ASSERT_EQUAL_STRING("100000000000000000000.00", text);
    number_text_fixed(text, 1e-30, 3);
    TEST_ASSERT_EQUAL_STRING("0.000", text);
    number_text_fixed(text, 1.0 / 3.0, 20);
    TEST_ASSERT_EQUAL_STRING("0.33333333333333331000", text);
    number_text_fixed(text, 1.7976931348623157e308, NUMBER_TEXT_DECIMALS_MAX);
    TEST_ASSERT_EQUAL_size_t(309 + 1 + NUMBER_TEXT_DECIMALS_MAX, strlen(text));
}

static uint64_t state = 88172645463325252u;

static uint64_t next_random(void) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

// Any finite double; every second one of the size people print.
static double random_double(unsigned i) {
    uint64_t bits = next_random();
    double number;
    memcpy(&number, &bits, sizeof number);
    if (i % 2 == 0 || !isfinite(number)) {
        number = ((double)(bits % 2000000) - 1e6) / (double)(1 + next_random() % 100000);
    }
    return number;
}

// printf rounds exact ties to even, we away from zero: only such a tie may differ.
static bool is_tie(double number, int decimals, const char *other) {
    char exact[1200];
    snprintf(exact, sizeof exact, "%.*e", 1100, number);
    const char *digits = strchr(exact, '.') + 1;
    return digits[decimals] == '5' &&
           strspn(digits + decimals + 1, "0") == (size_t)(1100 - decimals - 1) && strlen(other) > 0;
}

static void test_agrees_with_printf(void) {
    for (unsigned i = 0; i < 20000; i++) {
        double number = random_double(i);
        int decimals = (int)(next_random() % 17);
        char expected[400];
        snprintf(expected, sizeof expected, "%.*e", decimals, number);
        number_text_exponent(text, number, decimals);
        if (strcmp(expected, text) != 0) {
            TEST_ASSERT_TRUE_MESSAGE(is_tie(number, decimals, text), expected);
        }
    }
}

static void test_seventeen_digits_give_the_number_back(void) {
    for (unsigned i = 0; i < 20000; i++) {
        double number = random_double(i);
        number_text_general(text, number, 17);
        TEST_ASSERT_TRUE(strtod(text, NULL) == number);
    }
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

static void test_bases(void) {
    number_text_base(text, UINT64_MAX, 2, 0);
    TEST_ASSERT_EQUAL_size_t(64, strlen(text));
    number_text_base(text, 255, 16, 4);
    TEST_ASSERT_EQUAL_STRING("00FF", text);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_print);
    RUN_TEST(test_integers);
    RUN_TEST(test_ties_go_away_from_zero);
    RUN_TEST(test_long_fixed);
    RUN_TEST(test_agrees_with_printf);
    RUN_TEST(test_seventeen_digits_give_the_number_back);
    RUN_TEST(test_parse);
    RUN_TEST(test_bases);
    return UNITY_END();
}
