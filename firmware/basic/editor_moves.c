// Where the editor's cursor can go. Context: main loop.
#include "editor_moves.h"

#include <stddef.h>
#include <stdint.h>

#include "editor_cursor.h"
#include "editor_text.h"
#include "editor_view.h"

void editor_moves_left(void) {
    if (editor_cursor.place > 0) {
        editor_cursor_go(editor_text_before(editor_cursor.place));
    }
}

void editor_moves_right(void) {
    if (editor_cursor.place < editor_text_length()) {
        editor_cursor_go(editor_text_behind(editor_cursor.place));
    }
}

void editor_moves_up(void) {
    editor_cursor_go_lines(-1);
}

void editor_moves_down(void) {
    editor_cursor_go_lines(1);
}

void editor_moves_page_up(void) {
    editor_cursor_go_lines(1 - (long)editor_view_rows());
}

void editor_moves_page_down(void) {
    editor_cursor_go_lines((long)editor_view_rows() - 1);
}

void editor_moves_text_start(void) {
    editor_cursor_go(0);
}

void editor_moves_text_end(void) {
    editor_cursor_go(editor_text_length());
}

void editor_moves_home(bool again) {
    size_t start = editor_text_line_start(editor_cursor.place);
    editor_cursor_go(again && start == editor_cursor.place ? 0 : start);
}

void editor_moves_end(bool again) {
    size_t line_end = editor_text_line_end(editor_cursor.place);
    bool twice = again && line_end == editor_cursor.place;
    editor_cursor_go(twice ? editor_text_length() : line_end);
}

static bool is_word_part(size_t place) {
    char c = editor_text_at(place);
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '$' || (uint8_t)c >= 0x80;
}

void editor_moves_word_left(void) {
    size_t place = editor_cursor.place;
    while (place > 0 && !is_word_part(place - 1)) {
        place--;
    }
    while (place > 0 && is_word_part(place - 1)) {
        place--;
    }
    editor_cursor_go(place);
}

void editor_moves_word_right(void) {
    size_t place = editor_cursor.place;
    size_t length = editor_text_length();
    while (place < length && is_word_part(place)) {
        place++;
    }
    while (place < length && !is_word_part(place)) {
        place++;
    }
    editor_cursor_go(place);
}
