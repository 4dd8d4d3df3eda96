// The marked part of the text and the clipboard. Context: main loop.
#include "editor_block.h"

#include <string.h>

#include "editor_cursor.h"
#include "editor_text.h"
#include "editor_view.h"

#define NO_ROOM "Not enough memory: nothing was changed"

void editor_block_mark(void) {
    editor_cursor.anchor = editor_cursor.place;
    editor_cursor.marking = true;
}

void editor_block_copy(void) {
    size_t count;
    size_t begin = editor_cursor_marked(&count);
    if (!editor_text_clip(begin, count)) {
        editor_view_message(NO_ROOM);
        return;
    }
    editor_cursor.marking = false;
}

void editor_block_delete(void) {
    size_t count;
    size_t begin = editor_cursor_marked(&count);
    editor_cursor_erase(begin, count);
    editor_cursor.marking = false;
}

void editor_block_cut(void) {
    size_t count;
    size_t begin = editor_cursor_marked(&count);
    if (!editor_text_clip(begin, count)) {
        editor_view_message(NO_ROOM);
        return;
    }
    editor_cursor_erase(begin, count);
    editor_cursor.marking = false;
}

void editor_block_paste(void) {
    size_t count;
    const char *bytes = editor_text_clipboard(&count);
    if (count == 0) {
        editor_view_message("Nothing was copied or cut yet");
    } else if (!editor_cursor_insert(bytes, count)) {
        editor_view_message(NO_ROOM);
    }
}

// ---- Indenting ----------------------------------------------------------------------------------

// Puts blanks before the line, or takes them away; both up to a tab stop's width.
static void shift_line(size_t start, bool right) {
    unsigned tab = editor_cursor.tab;
    static const char blanks[] = "        ";
    if (right) {
        editor_cursor_go(start);
        if (start != editor_text_line_end(start) && !editor_cursor_insert(blanks, tab)) {
            editor_view_message(NO_ROOM);
        }
        return;
    }
    size_t count = 0;
    while (count < tab && editor_text_at(start + count) == ' ') {
        count++;
    }
    editor_cursor_erase(start, count == 0 && editor_text_at(start) == '\t' ? 1 : count);
}

// From the last line to the first, so that places before stay what they are. The lines are marked
// afterwards if they were before.
static void shift_lines(bool right) {
    bool marked = editor_cursor.marking;
    size_t count;
    size_t begin = editor_cursor_marked(&count);
    size_t end = begin + (count > 0 ? count - 1 : 0); // a mark that ends at a line's start
    size_t first = editor_text_line_start(begin);
    size_t lines = editor_text_count_lines(first, end) + 1;
    size_t column = editor_cursor_column(editor_cursor.place);
    size_t length = editor_text_length();
    for (size_t start = editor_text_line_start(end);; start = editor_text_line_start(start - 1)) {
        shift_line(start, right);
        if (start == first) {
            break;
        }
    }
    editor_cursor_go(first);
    if (marked) {
        editor_cursor.anchor = first;
        editor_cursor_go_lines((long)lines);
        editor_cursor.marking = true;
    } else { // the cursor stays where it was in its line
        size_t moved = length - editor_text_length();
        editor_cursor_go(editor_cursor_place_of(first, column > moved ? column - moved : 0));
    }
}

void editor_block_indent(void) {
    shift_lines(true);
}

void editor_block_unindent(void) {
    shift_lines(false);
}
