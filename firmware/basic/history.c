// The lines typed last: one after the other, each closed by a zero; the oldest fall off the front.
// Context: main loop.
#include "history.h"

#include <string.h>

#define HISTORY_SIZE 1024u

static struct {
    char bytes[HISTORY_SIZE];
    size_t used;
} history;

void history_clear(void) {
    history.used = 0;
}

// Start of the line that ends (with its zero) at `end`.
static size_t line_before(size_t end) {
    size_t start = end - 1;
    while (start > 0 && history.bytes[start - 1] != '\0') {
        start--;
    }
    return start;
}

static void drop_oldest(void) {
    size_t length = strlen(history.bytes) + 1;
    history.used -= length;
    memmove(history.bytes, history.bytes + length, history.used);
}

void history_add(const char *line, size_t length) {
    if (length == 0 || length >= HISTORY_SIZE || memchr(line, '\0', length) != NULL) {
        return;
    }
    if (history.used > 0) {
        size_t last = line_before(history.used);
        if (history.used - 1 - last == length && memcmp(history.bytes + last, line, length) == 0) {
            return;
        }
    }
    while (history.used + length + 1 > HISTORY_SIZE) {
        drop_oldest();
    }
    memcpy(history.bytes + history.used, line, length);
    history.used += length;
    history.bytes[history.used++] = '\0';
}

size_t history_get(unsigned age, char *line, size_t size) {
    size_t end = history.used;
    size_t start = end;
    for (unsigned i = 0; i < age; i++) {
        if (start == 0) {
            return 0;
        }
        end = start;
        start = line_before(end);
    }
    size_t length = end - start;
    if (length == 0 || size == 0) {
        return 0;
    }
    length--; // the zero
    if (length > size) {
        length = size;
    }
    memcpy(line, history.bytes + start, length);
    return length;
}
