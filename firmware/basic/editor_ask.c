// Questions at the bottom of the editor's screen. Context: main loop.
#include "editor_ask.h"

#include <stdint.h>
#include <string.h>

#include "base/base.h"
#include "editor_view.h"
#include "keys.h"

#define DELETE_BACK 127

static bool gives_up(int key) {
    return key == KEYS_ESCAPE || key == KEYS_CONTROL('C') || key == KEYS_NO_INPUT;
}

static void delete_last(char *answer) {
    size_t length = strlen(answer);
    while (length > 0 && ((uint8_t)answer[length - 1] & 0xC0) == 0x80) { // UTF-8
        length--;
    }
    answer[length > 0 ? length - 1 : 0] = '\0';
}

bool editor_ask_text(const char *question, char *answer, size_t size, int same_key) {
    bool fresh = true; // typing replaces what is there
    for (;;) {
        editor_view_ask(question, answer);
        int key = keys_read(UINT64_MAX);
        size_t length = strlen(answer);
        if (gives_up(key)) {
            return false;
        }
        if (key == KEYS_RETURN || key == same_key) {
            return length > 0 || same_key == KEYS_RETURN;
        }
        if (key == '\b' || key == DELETE_BACK) {
            delete_last(answer);
            fresh = false;
        } else if (key == KEYS_RIGHT || key == KEYS_END) {
            fresh = false;
        } else if (key >= ' ' && key < 256) {
            length = fresh ? 0 : length;
            fresh = false;
            if (length + 1 < size) {
                answer[length] = (char)key;
                answer[length + 1] = '\0';
            }
        }
    }
}

char editor_ask_key(const char *question, const char *keys) {
    for (;;) {
        editor_view_ask(question, "");
        int key = keys_read(UINT64_MAX);
        if (gives_up(key)) {
            return '\0';
        }
        char letter = key > 0 && key < 128 ? letters_upper((char)key) : '\0';
        if (letter != '\0' && strchr(keys, letter) != NULL) {
            return letter;
        }
    }
}
