// The text being edited.
//
//   | front | gap | back | clipboard |
//
// Context: main loop.
#include "editor_text.h"

#include <stdint.h>
#include <string.h>

static struct {
    char *bytes;
    size_t gap;   // first byte of the gap, and the place of the byte behind it
    size_t back;  // first byte behind the gap
    size_t end;   // behind the text; the clipboard starts here
    size_t limit; // behind the clipboard
    size_t line_ends;
} text;

void editor_text_start(void *memory, size_t size) {
    text.bytes = memory;
    text.gap = 0;
    text.back = text.end = text.limit = size;
    text.line_ends = 0;
}

size_t editor_text_length(void) {
    return text.gap + (text.end - text.back);
}

size_t editor_text_room(void) {
    return text.back - text.gap;
}

size_t editor_text_line_ends(void) {
    return text.line_ends;
}

char editor_text_at(size_t place) {
    if (place < text.gap) {
        return text.bytes[place];
    }
    place += text.back - text.gap;
    return place < text.end ? text.bytes[place] : '\0';
}

void editor_text_copy(size_t place, size_t count, char *bytes) {
    for (size_t i = 0; i < count; i++) {
        bytes[i] = editor_text_at(place + i);
    }
}

// ---- Changes ------------------------------------------------------------------------------------

static void move_gap(size_t place) {
    if (place < text.gap) {
        size_t count = text.gap - place;
        text.back -= count;
        memmove(text.bytes + text.back, text.bytes + place, count);
    } else {
        size_t count = place - text.gap;
        memmove(text.bytes + text.gap, text.bytes + text.back, count);
        text.back += count;
    }
    text.gap = place;
}

static size_t count_line_ends(const char *bytes, size_t count) {
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        found += bytes[i] == '\n';
    }
    return found;
}

bool editor_text_insert(size_t place, const char *bytes, size_t count) {
    if (count > editor_text_room()) {
        return false;
    }
    move_gap(place);
    memcpy(text.bytes + text.gap, bytes, count);
    text.gap += count;
    text.line_ends += count_line_ends(bytes, count);
    return true;
}

void editor_text_erase(size_t place, size_t count) {
    move_gap(place);
    text.line_ends -= count_line_ends(text.bytes + text.back, count);
    text.back += count;
}

const char *editor_text_flat(void) {
    move_gap(editor_text_length());
    return text.bytes;
}

// ---- Lines --------------------------------------------------------------------------------------

size_t editor_text_line_start(size_t place) {
    while (place > 0 && editor_text_at(place - 1) != '\n') {
        place--;
    }
    return place;
}

size_t editor_text_line_end(size_t place) {
    size_t length = editor_text_length();
    while (place < length && editor_text_at(place) != '\n') {
        place++;
    }
    return place;
}

size_t editor_text_count_lines(size_t place, size_t end) {
    size_t found = 0;
    for (; place < end; place++) {
        found += editor_text_at(place) == '\n';
    }
    return found;
}

size_t editor_text_place_of_line(size_t line) {
    size_t place = 0;
    size_t length = editor_text_length();
    for (; line > 0; line--) {
        size_t end = editor_text_line_end(place);
        if (end == length) {
            break;
        }
        place = end + 1;
    }
    return place;
}

// ---- Characters ---------------------------------------------------------------------------------

static bool is_continuation(char c) {
    return ((uint8_t)c & 0xC0) == 0x80;
}

// Bytes of the UTF-8 character that `first` opens; 1 if it opens none.
static size_t size_of(uint8_t first) {
    return first < 0xC2 || first > 0xF4 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

int editor_text_character(size_t place, size_t *size) {
    uint8_t first = (uint8_t)editor_text_at(place);
    size_t count = size_of(first);
    *size = 1;
    if (count == 1) {
        return first < 0x80 ? first : -1;
    }
    int code = first & (0x7F >> count);
    for (size_t i = 1; i < count; i++) {
        char c = editor_text_at(place + i);
        if (!is_continuation(c)) {
            return -1;
        }
        code = code << 6 | ((uint8_t)c & 0x3F);
    }
    *size = count;
    return code;
}

size_t editor_text_behind(size_t place) {
    size_t size;
    editor_text_character(place, &size);
    return place + size;
}

size_t editor_text_before(size_t place) {
    size_t start = place - 1;
    for (size_t back = 1; back < 4 && start > 0 && is_continuation(editor_text_at(start)); back++) {
        start--;
    }
    return editor_text_behind(start) == place ? start : place - 1;
}

// ---- Clipboard ----------------------------------------------------------------------------------

// Makes the clipboard `size` bytes; what is in it is lost.
static bool resize_clipboard(size_t size) {
    if (size > text.limit - text.end + editor_text_room()) {
        return false;
    }
    size_t count = text.end - text.back;
    size_t back = text.limit - size - count;
    memmove(text.bytes + back, text.bytes + text.back, count);
    text.back = back;
    text.end = back + count;
    return true;
}

bool editor_text_shrink(size_t count) {
    if (count > editor_text_room()) {
        return false;
    }
    memmove(text.bytes + text.back - count, text.bytes + text.back, text.limit - text.back);
    text.back -= count;
    text.end -= count;
    text.limit -= count;
    return true;
}

bool editor_text_clip(size_t place, size_t count) {
    if (!resize_clipboard(count)) {
        return false;
    }
    editor_text_copy(place, count, text.bytes + text.end);
    return true;
}

const char *editor_text_clipboard(size_t *length) {
    *length = text.limit - text.end;
    return text.bytes + text.end;
}
