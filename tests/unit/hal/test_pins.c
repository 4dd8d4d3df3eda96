// Pin names, the header's numbering (Raspberry Pi Pico datasheet, pinout) and reservations.
#include "hal/pins.h"

#include <string.h>

#include <unity.h>

void setUp(void) {
    for (unsigned gpio = 0; gpio < PINS_COUNT; gpio++) {
        pins_disclaim(gpio);
    }
}
void tearDown(void) {}

static void test_board_numbers(void) {
    TEST_ASSERT_EQUAL_UINT(1, pins_board_number(0));
    TEST_ASSERT_EQUAL_UINT(21, pins_board_number(16));
    TEST_ASSERT_EQUAL_UINT(29, pins_board_number(22));
    TEST_ASSERT_EQUAL_UINT(34, pins_board_number(28));
    TEST_ASSERT_EQUAL_UINT(0, pins_board_number(25));
    TEST_ASSERT_EQUAL_UINT(0, pins_board_number(PINS_COUNT));
    TEST_ASSERT_EQUAL_UINT(0, pins_board_number(PINS_NONE));
}

static void test_numbering_goes_both_ways(void) {
    unsigned found = 0;
    for (unsigned number = 0; number <= 41; number++) {
        unsigned gpio = pins_from_board_number(number);
        if (gpio != PINS_NONE) {
            TEST_ASSERT_EQUAL_UINT(number, pins_board_number(gpio));
            found++;
        }
    }
    TEST_ASSERT_EQUAL_UINT(26, found);
}

static void test_power_and_control_pins_are_nobodys(void) {
    static const unsigned numbers[] = {0, 3, 8, 13, 18, 23, 28, 30, 33, 35, 36, 37, 38, 39, 40, 41};
    for (size_t i = 0; i < COUNT_OF_ARRAY(numbers); i++) {
        TEST_ASSERT_EQUAL_UINT(PINS_NONE, pins_from_board_number(numbers[i]));
    }
}

static void test_user_pins(void) {
    unsigned count = 0;
    for (unsigned gpio = 0; gpio < 300; gpio++) {
        count += pins_is_user(gpio);
    }
    TEST_ASSERT_EQUAL_UINT(27, count);
    TEST_ASSERT_TRUE(pins_is_user(25));
    TEST_ASSERT_FALSE(pins_is_user(23));
    TEST_ASSERT_FALSE(pins_is_user(24));
    TEST_ASSERT_FALSE(pins_is_user(29));
    TEST_ASSERT_FALSE(pins_is_user(PINS_NONE));
}

static void test_names(void) {
    TEST_ASSERT_EQUAL_STRING("GP16 (pin 21)", pins_name(16));
    TEST_ASSERT_EQUAL_STRING("GP25", pins_name(25));
    TEST_ASSERT_EQUAL_STRING("none", pins_name(PINS_NONE));
}

static void test_why_not(void) {
    TEST_ASSERT_EQUAL_STRING("used by the board itself", pins_why_not(23));
    TEST_ASSERT_EQUAL_STRING("valid is GP0 to GP28", pins_why_not(30));
    TEST_ASSERT_EQUAL_STRING("VBUS", pins_why_not_board_number(40));
    for (unsigned number = 1; number <= 40; number++) { // each is a GPIO or has a use
        bool is_gpio = pins_from_board_number(number) != PINS_NONE;
        bool has_use = strncmp(pins_why_not_board_number(number), "valid", 5) != 0;
        TEST_ASSERT_TRUE(is_gpio != has_use);
    }
    TEST_ASSERT_EQUAL_STRING("valid is 1 to 40", pins_why_not_board_number(0));
    TEST_ASSERT_EQUAL_STRING("valid is 1 to 40", pins_why_not_board_number(41));
}

static void test_four_names_at_once(void) {
    const char *first = pins_name(0);
    pins_name(1);
    pins_name(2);
    pins_name(3);
    TEST_ASSERT_EQUAL_STRING("GP0 (pin 1)", first);
}

static void test_claim_and_disclaim(void) {
    TEST_ASSERT_NULL(pins_owner(2));
    TEST_ASSERT_EQUAL(ERR_OK, pins_claim(2, "STEPPER X step"));
    TEST_ASSERT_EQUAL_STRING("STEPPER X step", pins_owner(2));
    TEST_ASSERT_EQUAL(ERR_PIN_IN_USE, pins_claim(2, "STEPPER Y step"));
    TEST_ASSERT_EQUAL_STRING("Pin GP2 (pin 4) is in use by STEPPER X step", err_message());
    TEST_ASSERT_EQUAL_STRING("STEPPER X step", pins_owner(2));
    pins_disclaim(2);
    TEST_ASSERT_NULL(pins_owner(2));
    TEST_ASSERT_EQUAL(ERR_OK, pins_claim(2, "STEPPER Y step"));
}

static void test_impossible_claims(void) {
    TEST_ASSERT_EQUAL(ERR_PIN_INVALID, pins_claim(23, "x"));
    TEST_ASSERT_EQUAL_STRING("Invalid pin GP23", err_message());
    TEST_ASSERT_EQUAL(ERR_PIN_INVALID, pins_claim(PINS_NONE, "x"));
    pins_disclaim(PINS_NONE);
    TEST_ASSERT_NULL(pins_owner(PINS_NONE));
}

static void test_masks(void) {
    TEST_ASSERT_EQUAL_HEX32(1, pins_mask(0));
    TEST_ASSERT_EQUAL_HEX32(0x10000000, pins_mask(28));
    TEST_ASSERT_EQUAL_HEX32(0, pins_mask(PINS_NONE));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_board_numbers);
    RUN_TEST(test_numbering_goes_both_ways);
    RUN_TEST(test_power_and_control_pins_are_nobodys);
    RUN_TEST(test_user_pins);
    RUN_TEST(test_names);
    RUN_TEST(test_why_not);
    RUN_TEST(test_four_names_at_once);
    RUN_TEST(test_claim_and_disclaim);
    RUN_TEST(test_impossible_claims);
    RUN_TEST(test_masks);
    return UNITY_END();
}
