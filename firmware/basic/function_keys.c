// What the function keys type. The file has a record for each key that was set: its number, its
// length, its text. A damaged one costs the keys behind the damage. Context: main loop.
#include "function_keys.h"

#include <stdbool.h>
#include <string.h>

#include "console.h"
#include "files/files.h"
#include "memory.h"

#define FILE_NAME "/.keys"
#define FILE_MAX (FUNCTION_KEYS_COUNT * (FUNCTION_KEYS_TEXT_MAX + 2))

static const char *const first_texts[FUNCTION_KEYS_COUNT] = {
    "FILES\r", "RUN\r",      "LIST\r",           "EDIT\r",        "", "", "", "",
    "",        "AUTOSAVE\r", "XMODEM RECEIVE\r", "XMODEM SEND\r",
};

// Reads the next record. False: there is none.
static bool read_record(int file, unsigned *number, char *text, size_t *length) {
    uint8_t head[2];
    size_t got;
    if (files_read(file, head, sizeof head, &got) != ERR_OK || got != sizeof head) {
        return false;
    }
    *number = head[0];
    *length = head[1];
    bool good = *number >= 1 && *number <= FUNCTION_KEYS_COUNT && *length <= FUNCTION_KEYS_TEXT_MAX;
    return good && files_read(file, text, *length, &got) == ERR_OK && got == *length;
}

size_t function_keys_get(unsigned number, char *text) {
    int file;
    if (files_open(FILE_NAME, FILES_READ, &file) == ERR_OK) {
        unsigned key;
        size_t length;
        while (read_record(file, &key, text, &length)) {
            if (key == number) {
                files_close(file);
                return length;
            }
        }
        files_close(file);
    }
    size_t length = strlen(first_texts[number - 1]);
    memcpy(text, first_texts[number - 1], length);
    return length;
}

static size_t add_record(char *bytes, unsigned number, const char *text, size_t length) {
    bytes[0] = (char)number;
    bytes[1] = (char)length;
    memcpy(bytes + 2, text, length);
    return length + 2;
}

// The records of all other keys. Returns their bytes.
static size_t read_others(unsigned number, char *bytes) {
    int file;
    size_t size = 0;
    if (files_open(FILE_NAME, FILES_READ, &file) == ERR_OK) {
        unsigned key;
        size_t length;
        char text[FUNCTION_KEYS_TEXT_MAX];
        while (size + sizeof text + 2 <= FILE_MAX && read_record(file, &key, text, &length)) {
            size += key != number ? add_record(bytes + size, key, text, length) : 0;
        }
        files_close(file);
    }
    return size;
}

err_t function_keys_set(unsigned number, const char *text, size_t length) {
    char *bytes = memory_text(FILE_MAX); // until the statement ends
    size_t size = read_others(number, bytes);
    if (length > 0 && size + length + 2 <= FILE_MAX) {
        size += add_record(bytes + size, number, text, length);
    }
    return files_replace(FILE_NAME, bytes, size);
}

err_t function_keys_reset(void) {
    files_entry_t entry;
    return files_info(FILE_NAME, &entry) == ERR_OK ? files_remove(FILE_NAME) : ERR_OK;
}

static void print_record(unsigned number, const char *text, size_t length) {
    char start[24];
    format_text(start, sizeof start, "OPTION F%u \"", number);
    console_print(start);
    bool enter = length > 0 && text[length - 1] == '\r';
    console_write(text, length - enter);
    console_print(enter ? "\" + CHR$(13)" : "\"");
    console_new_line();
}

void function_keys_list(void) {
    int file;
    if (files_open(FILE_NAME, FILES_READ, &file) != ERR_OK) {
        return;
    }
    unsigned number;
    size_t length;
    char text[FUNCTION_KEYS_TEXT_MAX];
    while (read_record(file, &number, text, &length)) {
        print_record(number, text, length);
    }
    files_close(file);
}
