// The simulated flash behaves as NOR flash and its image survives.
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_storage.h"

static uint8_t page[HAL_STORAGE_PAGE];
static uint8_t got[HAL_STORAGE_PAGE];

void setUp(void) {
    fixture_reset();
}
void tearDown(void) {}

static uint8_t byte_at(uint32_t offset) {
    uint8_t byte;
    hal_storage_read(offset, &byte, 1);
    return byte;
}

static void test_it_starts_erased(void) {
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte_at(0));
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte_at(HAL_STORAGE_SIZE - 1));
}

static void test_programming_clears_bits_and_erasing_sets_them(void) {
    memset(page, 0xF5, sizeof page);
    TEST_ASSERT_TRUE(hal_storage_program(HAL_STORAGE_PAGE, page));
    memset(page, 0x3F, sizeof page);
    TEST_ASSERT_TRUE(hal_storage_program(HAL_STORAGE_PAGE, page));
    hal_storage_read(HAL_STORAGE_PAGE, got, sizeof got);
    TEST_ASSERT_EACH_EQUAL_HEX8(0x35, got, sizeof got);
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte_at(HAL_STORAGE_PAGE - 1));
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte_at(2 * HAL_STORAGE_PAGE));
    TEST_ASSERT_TRUE(hal_storage_program(HAL_STORAGE_SECTOR, page));
    TEST_ASSERT_TRUE(hal_storage_erase(0));
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte_at(HAL_STORAGE_PAGE));
    TEST_ASSERT_EQUAL_HEX8(0x3F, byte_at(HAL_STORAGE_SECTOR)); // the next sector stays
}

static void test_wrong_places_and_a_running_tick_are_refused(void) {
    memset(page, 0, sizeof page);
    TEST_ASSERT_FALSE(hal_storage_program(1, page));
    TEST_ASSERT_FALSE(hal_storage_program(HAL_STORAGE_SIZE, page));
    TEST_ASSERT_FALSE(hal_storage_erase(HAL_STORAGE_PAGE));
    TEST_ASSERT_FALSE(hal_storage_erase(HAL_STORAGE_SIZE));
    hal_tick_start();
    TEST_ASSERT_FALSE(hal_storage_program(2 * HAL_STORAGE_SECTOR, page));
    TEST_ASSERT_FALSE(hal_storage_erase(2 * HAL_STORAGE_SECTOR));
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte_at(2 * HAL_STORAGE_SECTOR));
}

static void use_image(void *path) {
    host_storage_open(path);
    page[0] = byte_at(0) & 0xF0; // each use clears more
    page[1] = (uint8_t)(byte_at(1) << 1);
    if (!hal_storage_program(0, page)) {
        abort();
    }
}

static void read_beyond(void *argument) {
    (void)argument;
    hal_storage_read(HAL_STORAGE_SIZE - 1, got, 2);
}

static void test_the_image_is_made_and_kept(void) {
    static char contents[HAL_STORAGE_SIZE + 2];
    char path[64];
    char message[300];
    memset(page, 0xFF, sizeof page);
    strcpy(path, fixture_file("flash.bin", "", 0));
    TEST_ASSERT_EQUAL_INT(0, fixture_exit_code(use_image, path, message, sizeof message));
    TEST_ASSERT_EQUAL_size_t(HAL_STORAGE_SIZE, fixture_read(path, contents, sizeof contents));
    TEST_ASSERT_EQUAL_HEX8(0xF0, contents[0]);
    TEST_ASSERT_EQUAL_HEX8(0xFE, contents[1]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, contents[HAL_STORAGE_SIZE - 1]);
    TEST_ASSERT_EQUAL_INT(0, fixture_exit_code(use_image, path, message, sizeof message));
    fixture_read(path, contents, sizeof contents);
    TEST_ASSERT_EQUAL_HEX8(0xFC, contents[1]);
}

static void test_unusable_images_are_reported(void) {
    char path[64];
    char message[300];
    strcpy(path, fixture_file("short.bin", "short", 5));
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(use_image, path, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "1310720 bytes, this file has 5\n"), message);
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(use_image, "/tmp", message, sizeof message));
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(use_image, "/dev/null", message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "not a regular file"), message);
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(read_beyond, NULL, message, sizeof message));

    strcpy(path, fixture_file("shared.bin", "", 0));
    host_storage_open(path); // last of all: this process keeps it
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(use_image, path, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "in use by another stepmite\n"), message);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_it_starts_erased);
    RUN_TEST(test_programming_clears_bits_and_erasing_sets_them);
    RUN_TEST(test_wrong_places_and_a_running_tick_are_refused);
    RUN_TEST(test_the_image_is_made_and_kept);
    RUN_TEST(test_unusable_images_are_reported);
    return UNITY_END();
}
