// Formatted text against the C library's.
#include "base/base.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <unity.h>

void setUp(void) {}
void tearDown(void) {}

#define SIZE 200

// Both must give the same text and length.
#define CHECK(...)                                                                                 \
    do {                                                                                           \
        char ours[SIZE], theirs[SIZE];                                                             \
        size_t length = format_text(ours, sizeof ours, __VA_ARGS__);                               \
        int expected = snprintf(theirs, sizeof theirs, __VA_ARGS__);                               \
        TEST_ASSERT_EQUAL_STRING(theirs, ours);                                                    \
        TEST_ASSERT_EQUAL_INT(expected, (int)length);                                              \
    } while (0)

static void test_texts(void) {
    CHECK("plain");
    CHECK("%s|%5s|%-5s|%.2s|%-6.1s|", "one", "two", "three", "four", "five");
    CHECK("%.*s|%*s|%-*s|%*s", 3, "abcdef", 5, "x", 5, "y", -4, "z");
    CHECK("%c%3c%-3c.", 'a', 'b', 'c');
    CHECK("100 %%");
}

static void test_integers(void) {
    CHECK("%d %i %u", -5, 7, 4000000000u);
    CHECK("%5d|%-5d|%05d|%+d|% d|%+05d", -42, -42, -42, 42, 42, 42);
    CHECK("%.3d|%6.3d", 7, 7);
    CHECK("%ld %lu %lld %llu %zu", -1L, ~0ul, -9223372036854775807LL - 1, ~0ull, (size_t)12);
    CHECK("%hd %hhu", (short)-3, (unsigned char)200);
    CHECK("%x %X %08lX %02x", 0xbeefu, 0xBEEFu, 0x1234ul, 10u);
}

static void test_doubles(void) {
    CHECK("%f %.3f %.0f %8.2f|%-8.2f|%08.2f", 1.25, 2.0 / 3, 3.7, -1.0, -1.0, -1.0);
    CHECK("%g %g %g %.9g %.3g", 0.1, 1e10, 123456789.0, 123456789.0, 0.00001234);
    CHECK("%e %.2e %12.1e|%+g|% g", 12345.678, 0.5, -1e-9, 2.0, 2.0);
    CHECK("%g %5g %-5g|%05g", HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL);
    CHECK("%*.*f", 10, 2, 3.14159);
}

static void test_what_does_not_fit_is_cut(void) {
    char text[8];
    memset(text, 'x', sizeof text);
    TEST_ASSERT_EQUAL_size_t(10, format_text(text, 6, "%s", "0123456789"));
    TEST_ASSERT_EQUAL_STRING("01234", text);
    TEST_ASSERT_EQUAL_CHAR('x', text[6]);
    TEST_ASSERT_EQUAL_size_t(3, format_text(NULL, 0, "%d", 123));
}

static void test_a_detail_may_quote_the_message(void) {
    char text[20] = "abc";
    format_text(text + 3, sizeof text - 3, "%.3s", text);
    TEST_ASSERT_EQUAL_STRING("abcabc", text);
}

static void test_what_is_not_known_stands_as_it_is(void) {
    char text[20];
    const char *format = "50 %! %k";
    va_list none = {0};
    format_list(text, sizeof text, format, none);
    TEST_ASSERT_EQUAL_STRING("50 %! %k", text);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_texts);
    RUN_TEST(test_integers);
    RUN_TEST(test_doubles);
    RUN_TEST(test_what_does_not_fit_is_cut);
    RUN_TEST(test_a_detail_may_quote_the_message);
    RUN_TEST(test_what_is_not_known_stands_as_it_is);
    return UNITY_END();
}
