// The line editor. Echo goes through the console's block, which is sent when the input pauses, so a
// pasted line costs one write. Context: main loop.
#include "line_editor.h"

#include <string.h>

#include "base/base.h"
#include "complete.h"
#include "console.h"
#include "function_keys.h"
#include "history.h"
#include "keys.h"
#include "line_screen.h"

#define DELETE_BACK 127

static struct {
    char line[LINE_EDITOR_MAX + 1];
    size_t length;
    size_t cursor;
    const line_editor_options_t *options;
    bool overwrite;
    bool too_long;
    bool active;
    bool entered; // a function key has the line ready
    bool tabbed;  // the key before was a Tab that led nowhere
    unsigned age; // lines back in the history, 0: the line being typed
} editor;

void line_editor_start(void) {
    history_clear();
    memset(&editor, 0, sizeof editor);
}

// ---- Screen -------------------------------------------------------------------------------------

static void set_cursor(size_t place) {
    if (place < editor.cursor) {
        line_screen_back(editor.cursor, place);
    } else {
        line_screen_write(editor.cursor, place);
    }
    editor.cursor = place;
}

bool line_editor_hide(void) {
    if (!editor.active) {
        return false;
    }
    line_screen_hide(editor.cursor, editor.length, editor.options->prompt);
    return true;
}

void line_editor_show(void) {
    console_print(editor.options->prompt);
    line_screen_start(editor.line);
    line_screen_write(0, editor.length);
    line_screen_back(editor.length, editor.cursor);
    console_flush();
}

static void replace_line(const char *text, size_t length) {
    set_cursor(0);
    memcpy(editor.line, text, length);
    editor.length = editor.cursor = length;
    line_screen_draw(0, length, length);
}

// ---- Moving -------------------------------------------------------------------------------------

static size_t before(size_t place) {
    while (place > 1 && line_screen_continues(editor.line[place - 1])) {
        place--;
    }
    return place > 0 ? place - 1 : 0;
}

static size_t behind(size_t place) {
    place += place < editor.length;
    while (place < editor.length && line_screen_continues(editor.line[place])) {
        place++;
    }
    return place;
}

static bool is_word_part(size_t place) {
    char c = editor.line[place];
    return c != ' ' && strchr("()\",:;=+-*/<>", c) == NULL;
}

static size_t word_before(size_t place) {
    while (place > 0 && !is_word_part(place - 1)) {
        place--;
    }
    while (place > 0 && is_word_part(place - 1)) {
        place--;
    }
    return place;
}

static size_t word_behind(size_t place) {
    while (place < editor.length && is_word_part(place)) {
        place++;
    }
    while (place < editor.length && !is_word_part(place)) {
        place++;
    }
    return place;
}

// ---- Changing -----------------------------------------------------------------------------------

// Takes out what stands from `place` up to the cursor or, if that is behind it, from the cursor on.
static void delete_to(size_t place) {
    size_t start = place < editor.cursor ? place : editor.cursor;
    size_t end = place < editor.cursor ? editor.cursor : place;
    if (start == end) {
        return;
    }
    set_cursor(start);
    memmove(editor.line + start, editor.line + end, editor.length - end);
    editor.length -= end - start;
    line_screen_draw(start, editor.length, start);
}

static void insert(char c) {
    bool continues = line_screen_continues(c);
    if (editor.overwrite && !continues && editor.cursor < editor.length) {
        size_t end = behind(editor.cursor);
        memmove(editor.line + editor.cursor, editor.line + end, editor.length - end);
        editor.length -= end - editor.cursor;
    }
    if (editor.length == LINE_EDITOR_MAX) {
        editor.too_long = true;
        return;
    }
    size_t place = editor.cursor;
    if (continues && place > 0 && place < editor.length) { // draw its character anew
        line_screen_back(place, before(place));
        place = before(place);
    }
    memmove(editor.line + editor.cursor + 1, editor.line + editor.cursor,
            editor.length - editor.cursor);
    editor.length++;
    editor.line[editor.cursor++] = c;
    if (editor.cursor == editor.length) {
        line_screen_write(place, editor.cursor);
    } else {
        line_screen_draw(place, editor.length, editor.cursor);
    }
}

static void recall(int step) {
    if (!editor.options->prompt_keys || (step < 0 && editor.age == 0)) {
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

// ---- Tab and function keys ----------------------------------------------------------------------

static void complete(void) {
    complete_t found;
    complete_find(editor.line, editor.cursor, &found);
    if (found.count == 0 && editor.cursor == 0) {
        insert(' ');
        return;
    }
    for (size_t i = 0; i < found.more_length; i++) {
        insert(found.more[i]);
    }
    bool stuck = found.count > 1 && found.more_length == 0;
    if (stuck && editor.tabbed) {
        set_cursor(editor.length);
        console_new_line();
        complete_list(editor.line, editor.cursor);
        line_editor_show();
    }
    editor.tabbed = stuck;
}

// A tab in a paste is a blank between words, or text.
static void tab(void) {
    if (editor.options->keep_tabs) {
        insert('\t');
    } else if (editor.options->prompt_keys && !keys_in_burst()) {
        complete();
    } else {
        insert(' ');
    }
}

static bool is_function_key(int key) {
    return key >= KEYS_F1 && key <= KEYS_F12;
}

// It types a text; with a carriage return in it that is a line.
static void press_function_key(int key) {
    if (!editor.options->prompt_keys) {
        return;
    }
    char text[FUNCTION_KEYS_TEXT_MAX];
    size_t length = function_keys_get((unsigned)(key - KEYS_F1) + 1, text);
    for (size_t i = 0; i < length && !editor.entered; i++) {
        if (text[i] == '\r') {
            editor.entered = true;
        } else {
            insert(text[i]);
        }
    }
}

// ---- Keys ---------------------------------------------------------------------------------------

// True if the key only moves the cursor.
static bool move(int key) {
    switch (key) {
    case KEYS_LEFT:
    case KEYS_CONTROL('S'):
        set_cursor(before(editor.cursor));
        return true;
    case KEYS_RIGHT:
    case KEYS_CONTROL('D'):
        set_cursor(behind(editor.cursor));
        return true;
    case KEYS_LEFT | KEYS_CTRL:
        set_cursor(word_before(editor.cursor));
        return true;
    case KEYS_RIGHT | KEYS_CTRL:
        set_cursor(word_behind(editor.cursor));
        return true;
    case KEYS_HOME:
    case KEYS_CONTROL('A'):
        set_cursor(0);
        return true;
    case KEYS_END:
    case KEYS_CONTROL('K'):
        set_cursor(editor.length);
        return true;
    default:
        return false;
    }
}

// A key that stands for nothing is a character, or noise.
static void type_key(int key) {
    if (is_function_key(key)) {
        press_function_key(key);
    } else if (key >= ' ' && key <= 255) {
        insert((char)key);
    } else if (key < ' ') {
        console_offer_control(key);
    }
}

static void change(int key) {
    switch (key) {
    case KEYS_INSERT:
    case KEYS_CONTROL('N'):
        editor.overwrite = !editor.overwrite;
        break;
    case '\b':
    case DELETE_BACK:
        delete_to(before(editor.cursor));
        break;
    case KEYS_CONTROL('W'):
        delete_to(word_before(editor.cursor));
        break;
    case KEYS_DELETE:
    case KEYS_CONTROL(']'):
        delete_to(behind(editor.cursor));
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
        tab();
        break;
    default:
        type_key(key);
        break;
    }
}

static void edit(int key) {
    if (!move(key)) {
        change(key);
    }
    editor.tabbed = editor.tabbed && key == KEYS_TAB;
}

static line_editor_result_t finish(line_editor_result_t result) {
    if (line_screen_has_rows_below(editor.cursor, editor.length)) {
        set_cursor(editor.length); // what comes next must not stand on the line's lower rows
    }
    console_new_line();
    editor.active = false;
    editor.line[editor.length] = '\0';
    if (editor.too_long && result != LINE_EDITOR_BREAK) {
        return LINE_EDITOR_TOO_LONG;
    }
    if (result == LINE_EDITOR_LINE && editor.options->prompt_keys) {
        history_add(editor.line, editor.length);
    }
    return result;
}

// True if the key ends the line, and how.
static bool ends_line(int key, line_editor_result_t *result) {
    bool finish_keys = editor.options->finish_keys;
    *result = LINE_EDITOR_LINE;
    if (console_is_break(key) || console_break_pending()) {
        editor.length = editor.cursor = 0;
        *result = LINE_EDITOR_BREAK;
    } else if (key == KEYS_NO_INPUT) {
        bool partial = editor.length > 0 || editor.too_long;
        *result = partial ? LINE_EDITOR_LINE : LINE_EDITOR_END;
    } else if (key == KEYS_CONTROL('Z') || (key == KEYS_F1 && finish_keys)) {
        *result = LINE_EDITOR_FINISHED;
    } else if (key == KEYS_F2 && finish_keys) {
        *result = LINE_EDITOR_FINISHED_RUN;
    } else {
        return key == KEYS_RETURN;
    }
    return true;
}

line_editor_result_t line_editor_read(const line_editor_options_t *options, const char **line,
                                      size_t *length) {
    editor.options = options;
    editor.length = editor.cursor = 0;
    editor.age = 0;
    editor.overwrite = editor.too_long = editor.entered = editor.tabbed = false;
    editor.active = true;
    console_print(options->prompt);
    line_screen_start(editor.line);
    line_editor_result_t result;
    int key;
    while (!ends_line(key = keys_read(UINT64_MAX), &result)) {
        edit(key);
        if (editor.entered) {
            break;
        }
    }
    if (result == LINE_EDITOR_END) {
        editor.active = false;
    } else {
        result = finish(result);
    }
    *line = editor.line;
    *length = editor.length;
    return result;
}
