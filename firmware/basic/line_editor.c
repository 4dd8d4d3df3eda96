// The line editor. Echo goes through the console's block, which is sent when the input pauses, so a
// pasted line costs one write. Context: main loop.
#include "line_editor.h"

#include <string.h>

#include "base/base.h"
#include "console.h"
#include "history.h"
#include "keys.h"

#define DELETE_BACK 127

static struct {
    char line[LINE_EDITOR_MAX + 1];
    size_t length;
    size_t cursor;
    const line_editor_options_t *options;
    bool overwrite;
    bool too_long;
    bool active;
    bool at_margin;
    unsigned age; // lines back in the history, 0: the line being typed
} editor;

void line_editor_start(void) {
    history_clear();
    memset(&editor, 0, sizeof editor);
}

// ---- Screen --------------------------------------------------------------------------------------

// Cells are counted from the start of the prompt, rows below each other. A terminal that has filled the
// last cell of a row stays there until the next character comes: that is at_margin.
static size_t cell_of(size_t place) {
    return strlen(editor.options->prompt) + place;
}

static size_t row_of_cursor(size_t place) {
    return cell_of(place) / console_columns() - (editor.at_margin ? 1 : 0);
}

static void write_line(size_t from, size_t to) {
    if (to > from) {
        console_write(editor.line + from, to - from);
        editor.at_margin = cell_of(to) % console_columns() == 0;
    }
}

static void print_sequence(size_t count, char letter) {
    char sequence[16];
    format_text(sequence, sizeof sequence, "\x1b[%u%c", (unsigned)count, letter);
    console_print(sequence);
}

// The screen's cursor from one place of the line to an earlier one.
static void move_back(size_t from, size_t to) {
    size_t rows = row_of_cursor(from) - cell_of(to) / console_columns();
    bool same_row = rows == 0 && !editor.at_margin;
    editor.at_margin = editor.at_margin && from == to;
    if (from == to) {
        return;
    }
    if (same_row) {
        if (from - to == 1) {
            console_print("\b");
        } else {
            print_sequence(from - to, 'D');
        }
        return;
    }
    if (rows > 0) {
        print_sequence(rows, 'A');
    }
    console_print("\r");
    if (cell_of(to) % console_columns() > 0) {
        print_sequence(cell_of(to) % console_columns(), 'C');
    }
}

// Draws the line from `from` on, where the screen's cursor is, and leaves it at editor.cursor.
static void draw_from(size_t from) {
    write_line(from, editor.length);
    if (editor.at_margin) { // erasing here would take the last character
        console_print(" \b");
        editor.at_margin = false;
    }
    console_print("\x1b[J");
    move_back(editor.length, editor.cursor);
}

static void set_cursor(size_t place) {
    if (place < editor.cursor) {
        move_back(editor.cursor, place);
    } else {
        write_line(editor.cursor, place);
    }
    editor.cursor = place;
}

bool line_editor_hide(void) {
    if (!editor.active) {
        return false;
    }
    size_t rows = row_of_cursor(editor.cursor);
    if (rows > 0) {
        print_sequence(rows, 'A');
    }
    console_print("\r\x1b[J");
    editor.at_margin = false;
    return true;
}

void line_editor_show(void) {
    console_print(editor.options->prompt);
    write_line(0, editor.length);
    move_back(editor.length, editor.cursor);
    console_flush();
}

static void replace_line(const char *text, size_t length) {
    set_cursor(0);
    memcpy(editor.line, text, length);
    editor.length = editor.cursor = length;
    draw_from(0);
}

// ---- Editing -------------------------------------------------------------------------------------

static void insert(char c) {
    bool replaces = editor.overwrite && editor.cursor < editor.length;
    if (!replaces && editor.length == LINE_EDITOR_MAX) {
        editor.too_long = true;
        return;
    }
    if (!replaces) {
        memmove(editor.line + editor.cursor + 1, editor.line + editor.cursor,
                editor.length - editor.cursor);
        editor.length++;
    }
    editor.line[editor.cursor++] = c;
    if (editor.cursor == editor.length) {
        write_line(editor.cursor - 1, editor.cursor);
    } else {
        draw_from(editor.cursor - 1);
    }
}

static void delete_at_cursor(void) {
    if (editor.cursor < editor.length) {
        memmove(editor.line + editor.cursor, editor.line + editor.cursor + 1,
                editor.length - editor.cursor - 1);
        editor.length--;
        draw_from(editor.cursor);
    }
}

static void recall(int step) {
    if (!editor.options->history || (step < 0 && editor.age == 0)) {
        return;
    }
    char line[LINE_EDITOR_MAX];
    unsigned age = editor.age + (unsigned)step;
    size_t length = age == 0 ? 0 : history_get(age, line, sizeof line);
    if (age != 0 && length == 0) {
        return;
    }
    editor.age = age;
    replace_line(line, length);
}

static void edit(int key) {
    switch (key) {
    case KEYS_LEFT:
        set_cursor(editor.cursor > 0 ? editor.cursor - 1 : 0);
        break;
    case KEYS_RIGHT:
        set_cursor(editor.cursor < editor.length ? editor.cursor + 1 : editor.cursor);
        break;
    case KEYS_HOME:
    case KEYS_CONTROL('A'):
        set_cursor(0);
        break;
    case KEYS_END:
        set_cursor(editor.length);
        break;
    case KEYS_INSERT:
        editor.overwrite = !editor.overwrite;
        break;
    case '\b':
    case DELETE_BACK:
        if (editor.cursor > 0) {
            set_cursor(editor.cursor - 1);
            delete_at_cursor();
        }
        break;
    case KEYS_DELETE:
        delete_at_cursor();
        break;
    case KEYS_CONTROL('U'):
        replace_line("", 0);
        break;
    case KEYS_UP:
    case KEYS_CONTROL('E'):
        recall(1);
        break;
    case KEYS_DOWN:
    case KEYS_CONTROL('X'):
        recall(-1);
        break;
    case KEYS_TAB:
        insert(editor.options->keep_tabs ? '\t' : ' ');
        break;
    default:
        if (key >= ' ' && key <= 255) {
            insert((char)key);
        } else if (key < ' ') { // nobody's: noise
            console_offer_control(key);
        }
        break;
    }
}

static line_editor_result_t finish(line_editor_result_t result) {
    if (editor.cursor < editor.length && cell_of(editor.length) > console_columns()) {
        set_cursor(editor.length); // what comes next must not stand on the line's lower rows
    }
    console_new_line();
    editor.active = false;
    editor.line[editor.length] = '\0';
    if (editor.too_long && result != LINE_EDITOR_BREAK) {
        return LINE_EDITOR_TOO_LONG;
    }
    if (result == LINE_EDITOR_LINE && editor.options->history) {
        history_add(editor.line, editor.length);
    }
    return result;
}

line_editor_result_t line_editor_read(const line_editor_options_t *options, const char **line,
                                      size_t *length) {
    editor.options = options;
    editor.length = editor.cursor = 0;
    editor.age = 0;
    editor.overwrite = editor.too_long = editor.at_margin = false;
    editor.active = true;
    console_print(options->prompt);
    line_editor_result_t result;
    for (;;) {
        int key = keys_read(UINT64_MAX);
        if (key == KEYS_RETURN) {
            result = finish(LINE_EDITOR_LINE);
            break;
        }
        if (console_is_break(key) || console_break_pending()) {
            editor.length = 0;
            result = finish(LINE_EDITOR_BREAK);
            break;
        }
        if (key == KEYS_CONTROL('Z') || key == KEYS_F1) {
            result = finish(LINE_EDITOR_FINISHED);
            break;
        }
        if (key == KEYS_F2) {
            result = finish(LINE_EDITOR_FINISHED_RUN);
            break;
        }
        if (key == KEYS_NO_INPUT) {
            editor.active = false;
            bool partial = editor.length > 0 || editor.too_long;
            result = partial ? finish(LINE_EDITOR_LINE) : LINE_EDITOR_END;
            break;
        }
        edit(key);
    }
    *line = editor.line;
    *length = editor.length;
    return result;
}
