// What the keys do in the editor: a table, and a short function for each command. Control keys are
// those of MMBasic's editor. Context: main loop.
#include "editor_commands.h"

#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "console.h"
#include "editor_ask.h"
#include "editor_block.h"
#include "editor_cursor.h"
#include "editor_find.h"
#include "editor_layout.h"
#include "editor_moves.h"
#include "editor_text.h"
#include "editor_undo.h"
#include "editor_view.h"
#include "keys.h"

#define DELETE_BACK 127
#define LINE_MAX 255 // of a program
#define NO_ROOM "Not enough memory: what does not fit was not put in"

typedef void (*run_t)(void);

static struct {
    void (*on_break)(void);
    editor_commands_end_t end;
    run_t last;   // the command before this one; NULL: a character was typed
    bool pasting; // between the brackets that a terminal puts around a paste
    bool next_to_machine;
    int last_key;
} commands;

void editor_commands_start(void (*on_break)(void)) {
    commands.on_break = on_break;
    commands.end = EDITOR_COMMANDS_GO_ON;
    commands.last = NULL;
    commands.pasting = commands.next_to_machine = false;
}

// ---- Moving -------------------------------------------------------------------------------------

// A second time in a row: the start of the text, its end.
static void home(void) {
    editor_moves_home(commands.last == home);
}

static void end(void) {
    editor_moves_end(commands.last == end);
}

// ---- Changing -----------------------------------------------------------------------------------

static void put_in(const char *bytes, size_t count) {
    if (!editor_cursor_insert(bytes, count)) {
        editor_view_message(NO_ROOM);
    }
}

static void type(char c) {
    size_t place = editor_cursor.place;
    bool continues = ((uint8_t)c & 0xC0) == 0x80; // a byte of a character that is there already
    if (editor_cursor.overwrite && !continues && !commands.pasting &&
        place < editor_text_line_end(place)) {
        editor_cursor_erase(place, editor_text_behind(place) - place);
    }
    put_in(&c, 1);
}

// A new line begins below the first letter of this one, unless it is pasted: it has its blanks with
// it.
static void enter(void) {
    char bytes[LINE_MAX + 1] = "\n";
    size_t count = 1;
    size_t start = editor_text_line_start(editor_cursor.place);
    if (!commands.pasting && !keys_in_burst()) {
        while (start < editor_cursor.place && editor_text_at(start) == ' ' && count < LINE_MAX) {
            bytes[count++] = ' ';
            start++;
        }
    }
    put_in(bytes, count);
}

static void delete_back(void) {
    if (editor_cursor.marking) {
        editor_block_delete();
    } else if (editor_cursor.place > 0) {
        size_t place = editor_text_before(editor_cursor.place);
        editor_cursor_erase(place, editor_cursor.place - place);
    }
}

static void delete(void) {
    if (editor_cursor.marking) {
        editor_block_delete();
    } else if (editor_cursor.place < editor_text_length()) {
        size_t place = editor_cursor.place;
        editor_cursor_erase(place, editor_text_behind(place) - place);
    }
}

static void delete_line(void) {
    size_t start = editor_text_line_start(editor_cursor.place);
    size_t line_end = editor_text_line_end(editor_cursor.place);
    editor_cursor_erase(start, line_end - start + (line_end < editor_text_length()));
}

static void tab(void) {
    if (editor_cursor.marking) {
        editor_block_indent();
        return;
    }
    size_t column = editor_cursor_column(editor_cursor.place);
    put_in("        ", editor_cursor.tab - column % editor_cursor.tab);
}

static void toggle_overwrite(void) {
    editor_cursor.overwrite = !editor_cursor.overwrite;
}

static void undo(void) {
    size_t place;
    bool complete;
    if (!editor_undo_step(&place, &complete)) {
        editor_view_message("Nothing to undo");
        return;
    }
    editor_cursor = (editor_cursor_t){
        .tab = editor_cursor.tab, .overwrite = editor_cursor.overwrite, .modified = true};
    editor_cursor_go(place);
    if (!complete) {
        editor_view_message("Not enough memory to undo that");
    }
}

// ---- Blocks -------------------------------------------------------------------------------------

static void mark_or_copy(void) {
    if (editor_cursor.marking) {
        editor_block_copy();
    } else {
        editor_block_mark();
    }
}

static void paste_or_cut(void) {
    if (editor_cursor.marking) {
        editor_block_cut();
    } else {
        editor_block_paste();
    }
}

// ---- Leaving ------------------------------------------------------------------------------------

static void save(void) {
    commands.end = EDITOR_COMMANDS_SAVE;
}

static void save_and_run(void) {
    commands.end = EDITOR_COMMANDS_RUN;
}

static void leave(void) {
    if (editor_cursor.marking) {
        editor_cursor.marking = false;
    } else if (!editor_cursor.modified ||
               editor_ask_key("Leave without saving? Y(es) N(o)", "YN") == 'Y') {
        commands.end = EDITOR_COMMANDS_LEAVE;
    }
}

// Ctrl-C copies, as elsewhere, what is marked. Else it may be the reflex of someone who wants the
// machine to stop: the second in a row does what it does at the prompt. The text stays in either
// case.
static void copy_or_break(void) {
    if (editor_cursor.marking) {
        editor_block_copy();
    } else if (commands.last_key == KEYS_CONTROL('C')) {
        editor_view_message("Ctrl-C");
        commands.on_break();
    } else {
        editor_view_message("ESC leaves. Ctrl-C again: as at the prompt, what moves is stopped");
    }
}

static void to_machine(void) {
    commands.next_to_machine = true;
    editor_view_message("The next key goes to the machine (Ctrl-C, Ctrl-F, Ctrl-R)");
}

static void begin_paste(void) {
    commands.pasting = true;
}

static void end_paste(void) {
    commands.pasting = false;
}

// ---- The table ----------------------------------------------------------------------------------

enum {
    MOVES = 1, // keeps the mark; with Shift it makes one
    MARK = 2,  // knows what to do with a mark
    JOINS = 4, // several in a row are taken back together
};

static const struct {
    int key;
    run_t run;
    unsigned flags;
} rows[] = {
    {KEYS_LEFT, editor_moves_left, MOVES},
    {KEYS_CONTROL('S'), editor_moves_left, MOVES},
    {KEYS_RIGHT, editor_moves_right, MOVES},
    {KEYS_CONTROL('D'), editor_moves_right, MOVES},
    {KEYS_UP, editor_moves_up, MOVES},
    {KEYS_CONTROL('E'), editor_moves_up, MOVES},
    {KEYS_DOWN, editor_moves_down, MOVES},
    {KEYS_CONTROL('X'), editor_moves_down, MOVES},
    {KEYS_HOME, home, MOVES},
    {KEYS_CONTROL('U'), home, MOVES},
    {KEYS_END, end, MOVES},
    {KEYS_CONTROL('K'), end, MOVES},
    {KEYS_PAGE_UP, editor_moves_page_up, MOVES},
    {KEYS_CONTROL('P'), editor_moves_page_up, MOVES},
    {KEYS_PAGE_DOWN, editor_moves_page_down, MOVES},
    {KEYS_CONTROL('L'), editor_moves_page_down, MOVES},
    {KEYS_HOME | KEYS_CTRL, editor_moves_text_start, MOVES},
    {KEYS_PAGE_UP | KEYS_CTRL, editor_moves_text_start, MOVES},
    {KEYS_END | KEYS_CTRL, editor_moves_text_end, MOVES},
    {KEYS_PAGE_DOWN | KEYS_CTRL, editor_moves_text_end, MOVES},
    {KEYS_LEFT | KEYS_CTRL, editor_moves_word_left, MOVES},
    {KEYS_CONTROL('A'), editor_moves_word_left, MOVES},
    {KEYS_RIGHT | KEYS_CTRL, editor_moves_word_right, MOVES},
    {KEYS_CONTROL('F'), editor_moves_word_right, MOVES},
    {'\b', delete_back, MARK | JOINS},
    {DELETE_BACK, delete_back, MARK | JOINS},
    {KEYS_DELETE, delete, MARK | JOINS},
    {KEYS_CONTROL(']'), delete, MARK | JOINS},
    {KEYS_F7, delete_line, 0},
    {KEYS_DELETE | KEYS_CTRL, delete_line, 0},
    {KEYS_RETURN, enter, 0},
    {KEYS_TAB, tab, MARK},
    {KEYS_BACK_TAB, editor_block_unindent, MARK},
    {KEYS_INSERT, toggle_overwrite, MARK},
    {KEYS_CONTROL('N'), toggle_overwrite, MARK},
    {KEYS_F6, undo, 0},
    {KEYS_CONTROL('Z'), undo, 0},
    {KEYS_F3, editor_find, MARK},
    {KEYS_CONTROL('R'), editor_find, MARK},
    {KEYS_F3 | KEYS_SHIFT, editor_find_next, MARK},
    {KEYS_CONTROL('G'), editor_find_next, MARK},
    {KEYS_F8, editor_find_replace, 0},
    {KEYS_F4, mark_or_copy, MARK},
    {KEYS_CONTROL('T'), mark_or_copy, MARK},
    {KEYS_F5, paste_or_cut, MARK},
    {KEYS_CONTROL('Y'), paste_or_cut, MARK},
    {KEYS_CONTROL('V'), editor_block_paste, 0},
    {KEYS_INSERT | KEYS_SHIFT, editor_block_paste, 0},
    {KEYS_CONTROL('C'), copy_or_break, MARK},
    {KEYS_F9, to_machine, MARK},
    {KEYS_F10, editor_layout_refresh, MARK},
    {KEYS_SIZE, editor_layout_resize, MARK},
    {KEYS_F1, save, 0},
    {KEYS_CONTROL('Q'), save, 0},
    {KEYS_F2, save_and_run, 0},
    {KEYS_CONTROL('W'), save_and_run, 0},
    {KEYS_ESCAPE, leave, MARK},
    {KEYS_PASTE_BEGIN, begin_paste, 0},
    {KEYS_PASTE_END, end_paste, 0},
};

static void run_row(size_t row) {
    if (!(rows[row].flags & (MOVES | MARK))) {
        editor_cursor.marking = false;
    }
    if (!(rows[row].flags & JOINS) || rows[row].run != commands.last) {
        editor_undo_new_step();
    }
    rows[row].run();
    commands.last = rows[row].run;
}

// True if the key is a command.
static bool run_command(int key) {
    for (size_t row = 0; row < COUNT_OF_ARRAY(rows); row++) {
        bool shifted = rows[row].flags & MOVES && key == (rows[row].key | KEYS_SHIFT) && key > 255;
        if (shifted && !editor_cursor.marking) {
            editor_block_mark();
        }
        if (shifted || rows[row].key == key) {
            run_row(row);
            return true;
        }
    }
    return false;
}

static void type_key(int key) {
    if (commands.last != NULL) { // what is typed in a row is taken back together
        editor_undo_new_step();
    }
    editor_cursor.marking = false;
    type((char)key);
    commands.last = NULL;
}

static void give_to_machine(int key) {
    commands.next_to_machine = false;
    if (key == KEYS_CONTROL('C')) {
        commands.on_break();
    } else if (key > ' ' || !console_offer_control(key)) {
        editor_view_message("Nothing came of it");
    }
}

editor_commands_end_t editor_commands_do(int key) {
    editor_view_clear_message();
    if (commands.next_to_machine) {
        give_to_machine(key);
    } else if (key == KEYS_CONTROL('F') && console_offer_control(key)) {
        // The machine holds: better than a word to the right.
    } else if (key >= ' ' && key < 256 && key != DELETE_BACK) {
        type_key(key);
    } else {
        run_command(key);
    }
    commands.last_key = key;
    return commands.end;
}

bool editor_commands_check(void) {
    size_t length = editor_text_length();
    for (size_t start = 0; start < length;) {
        size_t line_end = editor_text_line_end(start);
        if (line_end - start > LINE_MAX) {
            editor_cursor_go(start);
            editor_view_message("Not saved: this line has more than %d characters", LINE_MAX);
            return false;
        }
        start = line_end + 1;
    }
    return true;
}
