// What the editor shows. Context: main loop.
#include "editor_view.h"

#include <stdarg.h>
#include <string.h>

#include "base/base.h"
#include "editor_colour.h"
#include "editor_cursor.h"
#include "editor_screen.h"
#include "editor_text.h"

#define EXTRA_ROWS 2 // where one is, and the keys
#define MESSAGE_SIZE 100

static struct {
    const char *name;
    bool coloured;
    char message[MESSAGE_SIZE];
    // As of the last drawing.
    size_t line;
    size_t top_line;
    size_t line_ends;
} view;

static const char *const key_labels[] = {
    "F1 Save",  "F2 Run",   "F3 Find",     "F4 Mark",       "F5 Paste",   "F6 Undo",
    "ESC Exit", "F8 Repl.", "F7 Del.line", "F9 To machine", "F10 Redraw",
};

static const char *const mark_labels[] = {
    "MARK: move, then", "F4 Copy", "F5 Cut", "DEL Delete", "TAB Indent", "ESC Never mind",
};

void editor_view_start(const char *name, bool coloured) {
    memset(&view, 0, sizeof view);
    view.name = name;
    view.coloured = coloured;
    view.line_ends = editor_text_line_ends();
}

unsigned editor_view_rows(void) {
    return editor_screen_rows() - EXTRA_ROWS;
}

// ---- The text -----------------------------------------------------------------------------------

// What the window leaves out on the left so that the cursor is inside: it depends on the cursor
// alone.
static size_t left_of(size_t cursor_column) {
    size_t width = editor_screen_columns();
    if (cursor_column + 1 < width) {
        return 0;
    }
    size_t step = width / 2;
    return ((cursor_column + 2 - width) / step + 1) * step;
}

static bool is_marked(size_t place) {
    size_t count;
    size_t begin = editor_cursor_marked(&count);
    return place - begin < count;
}

static editor_screen_look_t look_at(editor_colour_t *colour, size_t place) {
    editor_screen_look_t look =
        view.coloured ? editor_colour_at(colour, place) : EDITOR_SCREEN_TEXT;
    return is_marked(place) ? EDITOR_SCREEN_INVERSE : look;
}

// Puts the line that starts at `place` together, from column `left` on.
static void put_line(size_t place, size_t left) {
    size_t width = editor_screen_columns();
    size_t end = editor_text_line_end(place);
    editor_colour_t colour = editor_colour_line(place);
    size_t column = 0;
    while (place < end && column <= left + width) {
        size_t size;
        size_t cells = editor_cursor_width(place, column, &size);
        editor_screen_look_t look = look_at(&colour, place);
        int code = editor_text_character(place, &size);
        for (size_t i = 0; i < cells; i++, column++) {
            bool cut = (left > 0 && column == left) ||
                       (column + 1 == left + width && (i + 1 < cells || place + size < end));
            if (column >= left && cut) {
                editor_screen_put(column == left ? '<' : '>', EDITOR_SCREEN_INVERSE);
            } else if (column >= left) {
                editor_screen_put(code == '\t' ? ' ' : code, look);
            }
        }
        place += size;
    }
    if (place == end && is_marked(end)) { // the end of the line is marked too
        editor_screen_put(' ', EDITOR_SCREEN_INVERSE);
    }
}

static void draw_text(size_t cursor_left) {
    const editor_cursor_t *cursor = &editor_cursor;
    size_t place = cursor->top;
    size_t lines = editor_text_line_ends() + 1;
    for (unsigned row = 0; row < editor_view_rows(); row++) {
        size_t line = cursor->top_line + row;
        if (line < lines) {
            put_line(place, line == cursor->line ? cursor_left : 0);
            place = editor_text_line_end(place) + 1;
        }
        editor_screen_end_row(row);
    }
}

// Moves the window so that the cursor is in it.
static void follow_cursor(void) {
    editor_cursor_t *cursor = &editor_cursor;
    size_t rows = editor_view_rows();
    if (cursor->line >= cursor->top_line && cursor->line < cursor->top_line + rows) {
        return;
    }
    bool near =
        cursor->line + rows > cursor->top_line && cursor->line < cursor->top_line + 2 * rows;
    size_t above = near ? (cursor->line < cursor->top_line ? 0 : rows - 1) : rows / 2;
    cursor->top = editor_text_line_start(cursor->place);
    cursor->top_line = cursor->line;
    for (; above > 0 && cursor->top > 0; above--) {
        cursor->top = editor_text_line_start(cursor->top - 1);
        cursor->top_line--;
    }
}

// Lets the terminal move rows that are only somewhere else now; drawing puts right what that left
// wrong.
static void move_rows(void) {
    const editor_cursor_t *cursor = &editor_cursor;
    unsigned rows = editor_view_rows();
    long scrolled = (long)view.top_line - (long)cursor->top_line;
    editor_screen_shift(0, rows,
                        scrolled < -(long)rows || scrolled > (long)rows ? 0 : (int)scrolled);
    long more = (long)editor_text_line_ends() - (long)view.line_ends;
    size_t first = (view.line < cursor->line ? view.line : cursor->line) + 1;
    bool inside = first > cursor->top_line && first < cursor->top_line + rows;
    if (inside && more > -(long)rows && more < (long)rows) {
        editor_screen_shift((unsigned)(first - cursor->top_line), rows, (int)more);
    }
    view.top_line = cursor->top_line;
    view.line = cursor->line;
    view.line_ends = editor_text_line_ends();
}

// ---- The lines below ----------------------------------------------------------------------------

static void draw_status(size_t column) {
    const editor_cursor_t *cursor = &editor_cursor;
    char text[60];
    editor_screen_print(cursor->modified ? "*" : " ", EDITOR_SCREEN_INVERSE);
    editor_screen_print(view.name != NULL ? view.name : "Program", EDITOR_SCREEN_INVERSE);
    unsigned width = editor_screen_columns();
    editor_screen_fill(width > 60 ? width - 50 : width / 3, EDITOR_SCREEN_INVERSE);
    format_text(text, sizeof text, " %s  Ln %4u of %-4u  Col %-4u %u KB free",
                cursor->overwrite ? "OVR" : "INS", (unsigned)cursor->line + 1,
                (unsigned)editor_text_line_ends() + 1, (unsigned)column + 1,
                (unsigned)editor_text_room() / 1024);
    editor_screen_print(text, EDITOR_SCREEN_INVERSE);
    editor_screen_fill(width, EDITOR_SCREEN_INVERSE);
    editor_screen_end_row(editor_view_rows());
}

static void put_labels(const char *const *labels, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (editor_screen_column() + 2 + strlen(labels[i]) > editor_screen_columns()) {
            break;
        }
        if (i > 0) {
            editor_screen_print("  ", EDITOR_SCREEN_TEXT);
        }
        editor_screen_print(labels[i], EDITOR_SCREEN_TEXT);
    }
}

static void draw_bottom(void) {
    if (view.message[0] != '\0') {
        editor_screen_print(view.message, EDITOR_SCREEN_INVERSE);
    } else if (editor_cursor.marking) {
        put_labels(mark_labels, sizeof mark_labels / sizeof mark_labels[0]);
    } else {
        put_labels(key_labels, sizeof key_labels / sizeof key_labels[0]);
    }
    editor_screen_end_row(editor_view_rows() + 1);
}

void editor_view_draw(void) {
    follow_cursor();
    move_rows();
    size_t column = editor_cursor_column(editor_cursor.place);
    size_t left = left_of(column);
    draw_text(left);
    draw_status(column);
    draw_bottom();
    editor_screen_set_cursor((unsigned)(editor_cursor.line - editor_cursor.top_line),
                             (unsigned)(column - left));
}

void editor_view_message(const char *format, ...) {
    va_list args;
    va_start(args, format);
    format_list(view.message, sizeof view.message, format, args);
    va_end(args);
}

void editor_view_clear_message(void) {
    view.message[0] = '\0';
}

void editor_view_ask(const char *question, const char *answer) {
    editor_screen_print(question, EDITOR_SCREEN_INVERSE);
    editor_screen_put(' ', EDITOR_SCREEN_TEXT);
    size_t room = editor_screen_columns() - editor_screen_column() - 1;
    size_t length = strlen(answer);
    editor_screen_print(answer + (length > room ? length - room : 0), EDITOR_SCREEN_TEXT);
    unsigned column = editor_screen_column();
    editor_screen_end_row(editor_view_rows() + 1);
    editor_screen_set_cursor(editor_view_rows() + 1, column);
}
