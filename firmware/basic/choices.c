// The words of a BASIC_ARG_CHOICE. Context: main loop.
#include "choices.h"

#include <string.h>

#include "base/base.h"

const char *choices_get(const char *choices, int index, size_t *length) {
    while (index-- > 0) {
        choices = strchr(choices, '|') + 1;
    }
    *length = strcspn(choices, "|");
    return choices;
}

int choices_find(const char *choices, const char *text, size_t length) {
    for (int index = 0; choices != NULL; index++) {
        size_t word_length = strcspn(choices, "|");
        if (word_length == length && letters_same(choices, text, length)) {
            return index;
        }
        choices = choices[word_length] == '|' ? choices + word_length + 1 : NULL;
    }
    return -1;
}

void choices_list(const char *choices, char *buffer, size_t size) {
    size_t used = 0;
    for (const char *p = choices; *p != '\0' && used + 3 < size; p++) {
        if (*p == '|') {
            buffer[used++] = ',';
            buffer[used++] = ' ';
        } else {
            buffer[used++] = *p;
        }
    }
    buffer[used] = '\0';
}
