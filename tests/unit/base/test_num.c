// Numerals: what is taken, where reading stops, and that the value is the one strtod() gives, bit
// for bit.
#include "base/base.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void) {}
void tearDown(void) {}

static num_t num;

// Number of characters read, or -1.
static int parse(const char *text, bool allow_exponent) {
    num = (num_t){.value = -1.0};
    const char *end = num_parse(text, text + strlen(text), allow_exponent, &num);
    return end == NULL ? -1 : (int)(end - text);
}

static void assert_parses(const char *text, int length, double value) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(length, parse(text, true), text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&value, &num.value, sizeof value, text);
}

static void test_integers(void) {
    assert_parses("0", 1, 0.0);
    TEST_ASSERT_TRUE(num.is_integer);
    assert_parses("0042", 4, 42.0);
    TEST_ASSERT_EQUAL_INT64(42, num.integer);
    assert_parses("9223372036854775807", 19, 9223372036854775807.0);
    TEST_ASSERT_TRUE(num.is_integer);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, num.integer);
    assert_parses("9223372036854775808", 19, 9223372036854775808.0);
    TEST_ASSERT_FALSE(num.is_integer);
    assert_parses("12345678901234567890123", 23, 12345678901234567890123.0);
    TEST_ASSERT_FALSE(num.is_integer);
}

static void test_decimals(void) {
    assert_parses("1.5", 3, 1.5);
    TEST_ASSERT_FALSE(num.is_integer);
    TEST_ASSERT_EQUAL_INT64(0, num.integer);
    assert_parses(".25", 3, 0.25);
    assert_parses("7.", 2, 7.0);
    TEST_ASSERT_FALSE(num.is_integer);
    assert_parses("0.1", 3, 0.1);
    assert_parses("0.30000000000000004", 19, 0.30000000000000004);
}

static void test_exponents(void) {
    assert_parses("1e3", 3, 1e3);
    TEST_ASSERT_FALSE(num.is_integer);
    assert_parses("1E-3", 4, 1e-3);
    assert_parses("2.5e+10", 7, 2.5e10);
    assert_parses("1.7976931348623157e308", 22, 1.7976931348623157e308);
    assert_parses("4.9e-324", 8, 4.9e-324);
    assert_parses("1e-999999999999", 15, 0.0);
}

static void test_reading_stops_where_the_numeral_ends(void) {
    assert_parses("10Y5", 2, 10.0);
    assert_parses("1.2.3", 3, 1.2);
    assert_parses("1e", 1, 1.0);
    TEST_ASSERT_TRUE(num.is_integer);
    assert_parses("1e+", 1, 1.0);
    assert_parses("0x10", 1, 0.0);
    assert_parses("1,5", 1, 1.0);
}

static void test_exponent_only_where_allowed(void) {
    TEST_ASSERT_EQUAL_INT(1, parse("1e3", false));
    TEST_ASSERT_TRUE(num.is_integer);
    TEST_ASSERT_EQUAL_INT64(1, num.integer);
}

static void test_end_of_text_is_respected(void) {
    const char *text = "12345";
    TEST_ASSERT_EQUAL_PTR(text + 2, num_parse(text, text + 2, true, &num));
    TEST_ASSERT_EQUAL_INT64(12, num.integer);
    text = "12e45";
    TEST_ASSERT_EQUAL_PTR(text + 2, num_parse(text, text + 3, true, &num));
}

static void test_what_is_no_numeral(void) {
    static const char *const texts[] = {"", ".", "-1", "+1", " 1", "e5", ".e5", "inf", "nan", "x"};
    for (size_t i = 0; i < COUNT_OF_ARRAY(texts); i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, parse(texts[i], true), texts[i]);
    }
}

static void test_beyond_double_is_refused(void) {
    TEST_ASSERT_EQUAL_INT(-1, parse("1e309", true));
    TEST_ASSERT_EQUAL_INT(-1, parse("1e999999999999", true));
    char text[512];
    memset(text, '9', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    TEST_ASSERT_EQUAL_INT(-1, parse(text, true));
}

static void test_very_long_numerals(void) {
    char text[1000];
    memset(text, '0', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    text[1] = '.';
    text[990] = '5';
    TEST_ASSERT_EQUAL_INT(999, parse(text, true));
    TEST_ASSERT_TRUE(num.value >= 0.0 && num.value < 1e-300);
    memset(text, '0', sizeof text - 1);
    text[998] = '7';
    assert_parses(text, 999, 7.0);
    memset(text, '0', sizeof text - 1);
    text[0] = '3';
    text[1] = '.';
    assert_parses(text, 999, 3.0);
}

// ---- Random numerals against the C library ------------------------------------------------------

static uint64_t random_state = 0x9E3779B97F4A7C15u;

static uint32_t random_below(uint32_t limit) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (uint32_t)(random_state >> 32) % limit;
}

static size_t put_digits(char *text, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        text[i] = (char)('0' + random_below(10));
    }
    return count;
}

static void make_numeral(char *text, size_t size) {
    size_t length = put_digits(text, 1 + random_below(random_below(8) == 0 ? 30 : 9));
    if (random_below(4) != 0) {
        text[length++] = '.';
        length += put_digits(text + length, random_below(random_below(8) == 0 ? 30 : 7));
    }
    text[length] = '\0';
    if (random_below(3) == 0) {
        int range = random_below(4) == 0 ? 340 : 30;
        int exponent = (int)random_below((uint32_t)(2 * range)) - range;
        snprintf(text + length, size - length, "e%d", exponent);
    }
}

static void test_random_numerals_match_strtod(void) {
    char text[100];
    for (int i = 0; i < 300000; i++) {
        make_numeral(text, sizeof text);
        double expected = strtod(text, NULL);
        if (isfinite(expected)) {
            assert_parses(text, (int)strlen(text), expected);
        } else {
            TEST_ASSERT_EQUAL_INT_MESSAGE(-1, parse(text, true), text);
        }
    }
}

// Up to a thousand digits: right at, and a last digit beside, the middle between two doubles.
static void test_ties_of_any_length(void) {
    char text[1200];
    for (int i = 0; i < 20000; i++) {
        uint64_t bits = (uint64_t)random_below(0x7FE00000u) << 32 | random_below(UINT32_MAX);
        if (i % 4 == 0) {
            bits >>= 12 + random_below(50); // the smallest of all
        }
        double value, next;
        memcpy(&value, &bits, sizeof value);
        bits++;
        memcpy(&next, &bits, sizeof next);
        long double middle = ((long double)value + (long double)next) / 2;
        snprintf(text, sizeof text, "%.*Le", (int)random_below(1100), middle);
        char *e = strchr(text, 'e');
        uint32_t change = random_below(3);
        if (change > 0 && e[-1] > '0' && e[-1] < '9') {
            e[-1] = (char)(e[-1] + (change == 1 ? 1 : -1));
        }
        assert_parses(text, (int)strlen(text), strtod(text, NULL));
    }
}

static void test_random_doubles_survive_17_digits(void) {
    char text[64];
    for (int i = 0; i < 100000; i++) {
        uint64_t bits = ((uint64_t)random_below(0x7FF00000u) << 32) | random_below(UINT32_MAX);
        double value;
        memcpy(&value, &bits, sizeof value);
        snprintf(text, sizeof text, "%.17g", value);
        assert_parses(text, (int)strlen(text), value);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_integers);
    RUN_TEST(test_decimals);
    RUN_TEST(test_exponents);
    RUN_TEST(test_reading_stops_where_the_numeral_ends);
    RUN_TEST(test_exponent_only_where_allowed);
    RUN_TEST(test_end_of_text_is_respected);
    RUN_TEST(test_what_is_no_numeral);
    RUN_TEST(test_beyond_double_is_refused);
    RUN_TEST(test_very_long_numerals);
    RUN_TEST(test_random_numerals_match_strtod);
    RUN_TEST(test_ties_of_any_length);
    RUN_TEST(test_random_doubles_survive_17_digits);
    return UNITY_END();
}
