// Numbers as text: agreement with the C library wherever it rounds the same way, that is everywhere
// but at exact ties, which it rounds to even and we away from zero.
#include "base/base.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unity.h>

void setUp(void) {}
void tearDown(void) {}

static char text[NUM_TEXT_SIZE];

static const char *fixed(double number, int decimals) {
    size_t length = num_text_fixed(text, number, decimals);
    TEST_ASSERT_EQUAL_size_t(strlen(text), length);
    return text;
}

static void test_integers(void) {
    num_text_integer(text, INT64_MIN);
    TEST_ASSERT_EQUAL_STRING("-9223372036854775808", text);
    num_text_integer(text, INT64_MAX);
    TEST_ASSERT_EQUAL_STRING("9223372036854775807", text);
    num_text_integer(text, 0);
    TEST_ASSERT_EQUAL_STRING("0", text);
}

static void test_bases(void) {
    num_text_unsigned(text, UINT64_MAX, 2, 0);
    TEST_ASSERT_EQUAL_size_t(64, strlen(text));
    num_text_unsigned(text, 255, 16, 4);
    TEST_ASSERT_EQUAL_STRING("00FF", text);
    num_text_unsigned(text, UINT64_MAX, 10, 0);
    TEST_ASSERT_EQUAL_STRING("18446744073709551615", text);
}

static void test_ties_go_away_from_zero(void) {
    TEST_ASSERT_EQUAL_STRING("1", fixed(0.5, 0));
    TEST_ASSERT_EQUAL_STRING("-3", fixed(-2.5, 0));
    TEST_ASSERT_EQUAL_STRING("0.13", fixed(0.125, 2));
    num_text_general(text, 1.5, 1);
    TEST_ASSERT_EQUAL_STRING("2", text);
    num_text_general(text, 2.5e21, 1); // exact, and beyond 64 bits
    TEST_ASSERT_EQUAL_STRING("3e+21", text);
}

static void test_zero(void) {
    TEST_ASSERT_EQUAL_STRING("0", fixed(0.0, 0));
    TEST_ASSERT_EQUAL_STRING("0.000", fixed(-0.0, 3));
    TEST_ASSERT_EQUAL_STRING("-0.000", fixed(-0.0001, 3));
    num_text_exponent(text, 0.0, 2);
    TEST_ASSERT_EQUAL_STRING("0.00e+00", text);
    num_text_general(text, 0.0, 6);
    TEST_ASSERT_EQUAL_STRING("0", text);
}

static void test_long_fixed(void) {
    TEST_ASSERT_EQUAL_STRING("100000000000000000000.00", fixed(1e20, 2));
    TEST_ASSERT_EQUAL_STRING("0.000", fixed(1e-30, 3));
    TEST_ASSERT_EQUAL_STRING("0.33333333333333331000", fixed(1.0 / 3.0, 20));
    TEST_ASSERT_EQUAL_STRING("0.000000000000000000000000000001", fixed(1e-30, 30));
    TEST_ASSERT_EQUAL_STRING("0.000000000000000000000000000000", fixed(4.9e-31, 30));
    TEST_ASSERT_EQUAL_STRING("99999999999999984.000", fixed(99999999999999984.0, 3));
    TEST_ASSERT_EQUAL_STRING("18446744073709552000", fixed(18446744073709551616.0, 0));
    fixed(1.7976931348623157e308, NUM_TEXT_DECIMALS_MAX);
    TEST_ASSERT_EQUAL_size_t(309 + 1 + NUM_TEXT_DECIMALS_MAX, strlen(text));
}

static void test_not_numbers(void) {
    TEST_ASSERT_EQUAL_STRING("inf", fixed(HUGE_VAL, 2));
    TEST_ASSERT_EQUAL_STRING("-inf", fixed(-HUGE_VAL, 2));
    TEST_ASSERT_EQUAL_STRING("nan", fixed(nan(""), 2));
}

// ---- Random numbers against the C library -------------------------------------------------------

static uint64_t state = 88172645463325252u;

static uint64_t next_random(void) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static double of_bits(uint64_t bits) {
    double number;
    memcpy(&number, &bits, sizeof number);
    return isfinite(number) ? number : 1.0 / (double)(bits | 1);
}

// Any finite double, the smallest of all, and of the size people print: as they are typed,
// integers, ties.
static double random_double(unsigned i) {
    uint64_t bits = next_random();
    switch (i % 6) {
    case 0:
        return of_bits(bits);
    case 1:
        return of_bits(bits >> 12 >> next_random() % 52);
    case 2:
        return (double)(int64_t)bits / (double)((uint64_t)1 << next_random() % 63);
    case 3:
        return (double)(int64_t)(bits >> next_random() % 63);
    case 4:
        return round(((double)(bits % 2000000) - 1e6) * 1e3) /
               pow(10.0, (double)(next_random() % 9));
    default:
        return ((double)(bits % 2000000) - 1e6) / (double)(1 + next_random() % 100000);
    }
}

// True if the digits behind the first `kept` of them are exactly a half.
static bool is_tie(double number, int kept) {
    char exact[1200];
    snprintf(exact, sizeof exact, "%.*e", 1100, number);
    const char *digits = exact + (*exact == '-');
    char all[1200];
    all[0] = '0';
    all[1] = digits[0];
    memcpy(all + 2, digits + 2, 1100);
    all[1102] = '\0';
    return kept >= 0 && all[1 + kept] == '5' &&
           strspn(all + 2 + kept, "0") == strlen(all + 2 + kept);
}

static int exponent_of(double number) {
    char shown[40];
    snprintf(shown, sizeof shown, "%.17e", number);
    return atoi(strchr(shown, 'e') + 1);
}

static void check(const char *expected, double number, int kept) {
    if (strcmp(expected, text) != 0 && !is_tie(number, kept)) {
        TEST_ASSERT_EQUAL_STRING(expected, text);
    }
}

static void test_exponent_agrees_with_printf(void) {
    for (unsigned i = 0; i < 200000; i++) {
        double number = random_double(i);
        int decimals = (int)(next_random() % 17);
        char expected[400];
        snprintf(expected, sizeof expected, "%.*e", decimals, number == 0.0 ? 0.0 : number);
        num_text_exponent(text, number, decimals);
        check(expected, number, decimals + 1);
    }
}

static void test_general_agrees_with_printf(void) {
    for (unsigned i = 0; i < 200000; i++) {
        double number = random_double(i);
        int digits = 1 + (int)(next_random() % 17);
        char expected[400];
        snprintf(expected, sizeof expected, "%.*g", digits, number == 0.0 ? 0.0 : number);
        num_text_general(text, number, digits);
        check(expected, number, digits);
    }
}

static void test_fixed_agrees_with_printf(void) {
    for (unsigned i = 0; i < 200000; i++) {
        double number = random_double(i);
        int exponent = number == 0.0 ? 0 : exponent_of(number);
        int decimals = (int)(next_random() % 31);
        if (exponent + decimals >= 16) { // more than 17 digits: ours end in zeros
            continue;
        }
        char expected[400];
        snprintf(expected, sizeof expected, "%.*f", decimals, number == 0.0 ? 0.0 : number);
        num_text_fixed(text, number, decimals);
        check(expected, number, exponent + 1 + decimals);
    }
}

static void test_seventeen_digits_give_the_number_back(void) {
    for (unsigned i = 0; i < 200000; i++) {
        double number = random_double(i);
        num_text_general(text, number, 17);
        TEST_ASSERT_TRUE_MESSAGE(strtod(text, NULL) == number, text);
        num_t back;
        const char *start = text + (*text == '-');
        TEST_ASSERT_NOT_NULL(num_parse(start, start + strlen(start), true, &back));
        TEST_ASSERT_TRUE_MESSAGE(back.value == fabs(number), text);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_integers);
    RUN_TEST(test_bases);
    RUN_TEST(test_ties_go_away_from_zero);
    RUN_TEST(test_zero);
    RUN_TEST(test_long_fixed);
    RUN_TEST(test_not_numbers);
    RUN_TEST(test_exponent_agrees_with_printf);
    RUN_TEST(test_general_agrees_with_printf);
    RUN_TEST(test_fixed_agrees_with_printf);
    RUN_TEST(test_seventeen_digits_give_the_number_back);
    return UNITY_END();
}
