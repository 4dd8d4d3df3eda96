// Where one is in the text being edited. Context: main loop.
#include "editor_cursor.h"

#include "editor_text.h"
#include "editor_undo.h"

editor_cursor_t editor_cursor;

void editor_cursor_start(unsigned tab) {
    editor_cursor = (editor_cursor_t){.tab = tab};
}

size_t editor_cursor_width(size_t place, size_t column, size_t *size) {
    int code = editor_text_character(place, size);
    return code == '\t' ? editor_cursor.tab - column % editor_cursor.tab : 1;
}

size_t editor_cursor_column(size_t place) {
    size_t column = 0;
    size_t size;
    for (size_t at = editor_text_line_start(place); at < place; at += size) {
        column += editor_cursor_width(at, column, &size);
    }
    return column;
}

size_t editor_cursor_place_of(size_t start, size_t column) {
    size_t end = editor_text_line_end(start);
    size_t at = 0;
    size_t size;
    while (start < end) {
        size_t width = editor_cursor_width(start, at, &size);
        if (at + width > column) {
            break;
        }
        at += width;
        start += size;
    }
    return start;
}

static void move_to(size_t place) {
    editor_cursor_t *cursor = &editor_cursor;
    if (place > cursor->place) {
        cursor->line += editor_text_count_lines(cursor->place, place);
    } else {
        cursor->line -= editor_text_count_lines(place, cursor->place);
    }
    cursor->place = place;
}

void editor_cursor_go(size_t place) {
    move_to(place);
    editor_cursor.wanted_column = editor_cursor_column(place);
}

void editor_cursor_go_lines(long lines) {
    size_t start = editor_text_line_start(editor_cursor.place);
    for (; lines < 0 && start > 0; lines++) {
        start = editor_text_line_start(start - 1);
    }
    for (; lines > 0; lines--) {
        size_t end = editor_text_line_end(start);
        if (end == editor_text_length()) {
            break;
        }
        start = end + 1;
    }
    move_to(editor_cursor_place_of(start, editor_cursor.wanted_column));
}

// The text from `place` on is about to change: the screen must not start behind that.
static void keep_top_before(size_t place) {
    editor_cursor_t *cursor = &editor_cursor;
    if (place < cursor->top) {
        size_t start = editor_text_line_start(place);
        cursor->top_line -= editor_text_count_lines(start, cursor->top);
        cursor->top = start;
    }
}

bool editor_cursor_insert(const char *bytes, size_t count) {
    editor_cursor_t *cursor = &editor_cursor;
    size_t place = cursor->place;
    keep_top_before(place);
    if (!editor_text_insert(place, bytes, count)) {
        return false;
    }
    editor_undo_inserted(place, count);
    cursor->modified = true;
    cursor->marking = false;
    editor_cursor_go(place + count);
    return true;
}

void editor_cursor_erase(size_t place, size_t count) {
    if (count == 0) {
        return;
    }
    editor_cursor_go(place);
    keep_top_before(place);
    editor_undo_erasing(place, count);
    editor_text_erase(place, count);
    editor_cursor.modified = true;
    editor_cursor.marking = false;
}

size_t editor_cursor_marked(size_t *count) {
    size_t begin = editor_cursor.place;
    size_t end = editor_cursor.anchor;
    *count = 0;
    if (!editor_cursor.marking) {
        return begin;
    }
    if (end < begin) {
        begin = editor_cursor.anchor;
        end = editor_cursor.place;
    }
    *count = end - begin;
    return begin;
}
