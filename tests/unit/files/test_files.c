// The flash file system: what is written is there, also after a restart; bad input and a busy flash
// lose nothing.
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "files/files.h"
#include "fixture.h"
#include "hal/hal.h"

#define FILE_SYSTEM_START (256u * 1024u)

void setUp(void) {
    fixture_reset();
    for (uint32_t at = 0; at < HAL_STORAGE_SIZE; at += HAL_STORAGE_SECTOR) {
        hal_storage_erase(at);
    }
    TEST_ASSERT_EQUAL(ERR_OK, files_start());
}
void tearDown(void) {}

static void put(const char *path, const char *text) {
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, files_replace(path, text, strlen(text)), err_message());
}

static const char *contents(const char *path) {
    static char text[4096];
    int handle;
    size_t got;
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, files_open(path, FILES_READ, &handle), path);
    TEST_ASSERT_EQUAL(ERR_OK, files_read(handle, text, sizeof text - 1, &got));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(handle));
    text[got] = '\0';
    return text;
}

static void expect(err_t code, err_t got, const char *message) {
    TEST_ASSERT_EQUAL_MESSAGE(code, got, message);
    TEST_ASSERT_EQUAL_STRING(message, err_message());
}

static void test_a_blank_flash_is_an_empty_folder_and_stays_untouched(void) {
    files_entry_t entry;
    uint32_t total, used;
    int handle;
    TEST_ASSERT_EQUAL(ERR_OK, files_list_start("/"));
    TEST_ASSERT_FALSE(files_list_next(&entry));
    TEST_ASSERT_EQUAL(ERR_OK, files_space(&total, &used));
    TEST_ASSERT_EQUAL_UINT32(1024 * 1024, total);
    expect(ERR_FILE_NOT_FOUND, files_open("x", FILES_READ, &handle), "File not found: /x");
    uint8_t byte;
    hal_storage_read(FILE_SYSTEM_START, &byte, 1);
    TEST_ASSERT_EQUAL_HEX8(0xFF, byte);
}

static void test_contents_survive_a_restart(void) {
    put("a.txt", "first");
    put("A:/b.txt", "");
    put("a.txt", "second");
    TEST_ASSERT_EQUAL(ERR_OK, files_start());
    TEST_ASSERT_EQUAL_STRING("second", contents("/a.txt"));
    TEST_ASSERT_EQUAL_STRING("", contents("b.txt"));
}

static void test_files_of_many_blocks_are_read_anywhere(void) {
    char line[32], got_line[32];
    int handle;
    size_t got;
    TEST_ASSERT_EQUAL(ERR_OK, files_open("long", FILES_WRITE, &handle));
    for (int i = 0; i < 2000; i++) {
        snprintf(line, sizeof line, "line %014d\n", i);
        TEST_ASSERT_EQUAL(ERR_OK, files_write(handle, line, 20));
        TEST_ASSERT_EQUAL_UINT32((i + 1) * 20, files_size(handle));
    }
    TEST_ASSERT_EQUAL(ERR_OK, files_close(handle));
    TEST_ASSERT_EQUAL(ERR_OK, files_open("long", FILES_UPDATE, &handle));
    TEST_ASSERT_EQUAL(ERR_OK, files_seek(handle, 20 * 1234));
    TEST_ASSERT_EQUAL(ERR_OK, files_write(handle, "LINE", 4));
    TEST_ASSERT_EQUAL(ERR_OK, files_seek(handle, 20 * 1234));
    TEST_ASSERT_EQUAL(ERR_OK, files_read(handle, got_line, 20, &got));
    TEST_ASSERT_EQUAL_STRING_LEN("LINE 00000000001234\n", got_line, 20);
    TEST_ASSERT_EQUAL_UINT32(20 * 1235, files_position(handle));
    expect(ERR_FILE_POSITION, files_seek(handle, 40001), "Beyond the end of the file");
    TEST_ASSERT_EQUAL(ERR_OK, files_seek(handle, 40000));
    TEST_ASSERT_EQUAL(ERR_OK, files_read(handle, got_line, 20, &got));
    TEST_ASSERT_EQUAL_size_t(0, got);
    TEST_ASSERT_EQUAL(ERR_OK, files_close(handle));
}

static void test_appending_and_modes(void) {
    int handle;
    size_t got;
    char byte;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(ERR_OK, files_open("log", FILES_APPEND, &handle));
        TEST_ASSERT_EQUAL(ERR_OK, files_write(handle, "entry;", 6));
        expect(ERR_FILE_MODE, files_read(handle, &byte, 1, &got), "The file is not open for this");
        TEST_ASSERT_EQUAL(ERR_OK, files_close(handle));
    }
    TEST_ASSERT_EQUAL_STRING("entry;entry;entry;", contents("log"));
    TEST_ASSERT_EQUAL(ERR_OK, files_open("log", FILES_READ, &handle));
    TEST_ASSERT_EQUAL(ERR_FILE_MODE, files_write(handle, "x", 1));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(handle));
}

static void test_folders_and_paths(void) {
    files_entry_t entry;
    TEST_ASSERT_EQUAL(ERR_OK, files_make_folder("parts"));
    TEST_ASSERT_EQUAL(ERR_OK, files_change_folder("parts"));
    TEST_ASSERT_EQUAL_STRING("/parts", files_folder());
    put("plate.nc", "G0 X1");
    put("../top", "1");
    TEST_ASSERT_EQUAL_STRING("G0 X1", contents("a:\\parts\\.\\plate.nc"));
    expect(ERR_FOLDER_IN_USE, files_remove_folder("/parts"),
           "The folder is not empty or in use: /parts");
    TEST_ASSERT_EQUAL(ERR_OK, files_change_folder(".."));
    TEST_ASSERT_EQUAL(ERR_FOLDER_IN_USE, files_remove_folder("/parts"));
    expect(ERR_IS_A_FOLDER, files_remove("parts"), "It is a folder: /parts");
    expect(ERR_FILE_EXISTS, files_make_folder("parts"), "File exists already: /parts");
    expect(ERR_NOT_A_FOLDER, files_change_folder("top"), "Not a folder: /top");
    TEST_ASSERT_EQUAL(ERR_OK, files_rename("parts/plate.nc", "plate.nc"));
    TEST_ASSERT_EQUAL(ERR_OK, files_remove_folder("parts"));
    TEST_ASSERT_EQUAL(ERR_OK, files_list_start("."));
    unsigned count = 0;
    while (files_list_next(&entry)) {
        count += strcmp(entry.name, "plate.nc") == 0 && entry.size == 5 && !entry.is_folder;
        count += strcmp(entry.name, "top") == 0 && entry.size == 1;
    }
    TEST_ASSERT_EQUAL_UINT(2, count);
}

static void test_bad_names_are_refused(void) {
    static const char *const names[] = {
        "",
        "x:b",
        "B:/x",
        "what?",
        "a*",
        "tab\there",
        "\x7F",
        "123456789012345678901234567890123456789012345678901234567890.txt",
        "/12345678901234567890123456789012345/12345678901234567890123456789012345/"
        "12345678901234567890123456789012345/12345678901234567890",
    };
    int handle;
    for (size_t i = 0; i < COUNT_OF_ARRAY(names); i++) {
        TEST_ASSERT_EQUAL_MESSAGE(ERR_FILE_BAD_NAME, files_open(names[i], FILES_WRITE, &handle),
                                  names[i]);
    }
    TEST_ASSERT_EQUAL(ERR_FILE_NOT_FOUND, files_open("no/file", FILES_WRITE, &handle));
}

static void test_a_file_being_written_is_open_once(void) {
    int writer, reader, other;
    put("x", "old");
    TEST_ASSERT_EQUAL(ERR_OK, files_open("x", FILES_READ, &reader));
    expect(ERR_FILE_IN_USE, files_open("x", FILES_WRITE, &writer), "File is open: /x");
    TEST_ASSERT_EQUAL(ERR_FILE_IN_USE, files_remove("x"));
    TEST_ASSERT_EQUAL(ERR_FILE_IN_USE, files_rename("x", "y"));
    TEST_ASSERT_EQUAL(ERR_FILE_IN_USE, files_replace("x", "new", 3));
    TEST_ASSERT_EQUAL(ERR_OK, files_open("x", FILES_READ, &other));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(reader));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(other));
    TEST_ASSERT_EQUAL(ERR_OK, files_open("x", FILES_WRITE, &writer));
    TEST_ASSERT_EQUAL(ERR_FILE_IN_USE, files_open("x", FILES_READ, &reader));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(writer));
    int handles[FILES_OPEN_MAX];
    for (int i = 0; i < FILES_OPEN_MAX; i++) {
        TEST_ASSERT_EQUAL(ERR_OK, files_open("x", FILES_READ, &handles[i]));
    }
    expect(ERR_FILES_TOO_MANY, files_open("x", FILES_READ, &other), "Too many files are open");
    for (int i = 0; i < FILES_OPEN_MAX; i++) {
        TEST_ASSERT_EQUAL(ERR_OK, files_close(handles[i]));
    }
}

static void test_a_full_flash_keeps_what_is_there(void) {
    static char block[8192];
    memset(block, 'x', sizeof block);
    put("keep", "precious");
    int handle;
    TEST_ASSERT_EQUAL(ERR_OK, files_open("big", FILES_WRITE, &handle));
    err_t error = ERR_OK;
    for (int i = 0; i < 200 && error == ERR_OK; i++) {
        error = files_write(handle, block, sizeof block);
    }
    expect(ERR_DISK_FULL, error, "Not enough space on A:");
    files_close(handle);
    TEST_ASSERT_EQUAL(ERR_OK,
                      files_start()); // nothing of "big" was closed: its space is free again
    TEST_ASSERT_EQUAL_STRING("precious", contents("keep"));
    put("keep", "more");
    TEST_ASSERT_EQUAL_STRING("more", contents("keep"));
}

// ---- Motion -------------------------------------------------------------------------------------

static void test_nothing_is_written_while_the_flash_is_busy_and_nothing_lost(void) {
    static char block[300];
    memset(block, 'b', sizeof block);
    int small, large, other;
    put("x", "old");
    TEST_ASSERT_EQUAL(ERR_OK, files_open("small", FILES_WRITE, &small));
    TEST_ASSERT_EQUAL(ERR_OK, files_open("large", FILES_WRITE, &large));
    TEST_ASSERT_EQUAL(ERR_OK, files_write(large, block, 300)); // 44 of them still in the buffer
    hal_tick_start();
    TEST_ASSERT_EQUAL_STRING("old", contents("x"));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_replace("x", "new", 3));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_remove("x"));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_rename("x", "y"));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_make_folder("f"));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_open("z", FILES_APPEND, &other));
    TEST_ASSERT_EQUAL(ERR_OK, files_write(small, block, 128));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_write(small, "!", 1));
    TEST_ASSERT_EQUAL(ERR_OK, files_write(large, block, 128 - 44 - 1));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_write(large, "!", 1));
    TEST_ASSERT_EQUAL(ERR_STORAGE_BUSY, files_flush(large));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(small)); // later
    TEST_ASSERT_EQUAL(ERR_FILE_IN_USE, files_open("small", FILES_READ, &other));
    files_background();
    hal_tick_stop();
    files_background();
    TEST_ASSERT_EQUAL_size_t(128, strlen(contents("small")));
    TEST_ASSERT_EQUAL(ERR_OK, files_write(large, "!", 1));
    TEST_ASSERT_EQUAL(ERR_OK, files_close(large));
    TEST_ASSERT_EQUAL_size_t(300 + 83 + 1, strlen(contents("large")));
}

static void test_what_is_no_file_system_is_said_and_made_anew(void) {
    uint8_t page[HAL_STORAGE_PAGE];
    put("x", "lost");
    memset(page, 0, sizeof page);
    for (uint32_t at = 0; at < 2 * HAL_STORAGE_SECTOR; at += HAL_STORAGE_PAGE) {
        hal_storage_program(FILE_SYSTEM_START + at, page);
    }
    expect(ERR_FILES_DAMAGED, files_start(), "The files on A: are damaged");
    int handle;
    TEST_ASSERT_EQUAL(ERR_FILE_NOT_FOUND, files_open("x", FILES_READ, &handle));
    put("y", "new");
    TEST_ASSERT_EQUAL(ERR_OK, files_start());
    TEST_ASSERT_EQUAL_STRING("new", contents("y"));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_blank_flash_is_an_empty_folder_and_stays_untouched);
    RUN_TEST(test_contents_survive_a_restart);
    RUN_TEST(test_files_of_many_blocks_are_read_anywhere);
    RUN_TEST(test_appending_and_modes);
    RUN_TEST(test_folders_and_paths);
    RUN_TEST(test_bad_names_are_refused);
    RUN_TEST(test_a_file_being_written_is_open_once);
    RUN_TEST(test_a_full_flash_keeps_what_is_there);
    RUN_TEST(test_nothing_is_written_while_the_flash_is_busy_and_nothing_lost);
    RUN_TEST(test_what_is_no_file_system_is_said_and_made_anew);
    return UNITY_END();
}
