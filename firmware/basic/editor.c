// EDIT: the screen, the loop and what belongs to no key. The text, what can be taken back and the
// cells of the screen lie in the free part of the arena. Context: main loop.
#include "editor.h"

#include <stdint.h>

#include "console.h"
#include "editor_commands.h"
#include "editor_cursor.h"
#include "editor_screen.h"
#include "editor_store.h"
#include "editor_text.h"
#include "editor_undo.h"
#include "editor_view.h"
#include "hal/hal.h"
#include "keys.h"
#include "memory.h"
#include "options.h"
#include "program.h"

#define RESERVE 2048u             // stays free in the arena: what keeping the text needs
#define ROOM_WANTED (32u * 1024u) // to write in; if there is less, variables give way
#define SIZE_WAIT_US 150000u      // how long the terminal may take to tell its size
#define DRAW_AT_LEAST_US 300000u  // so often something is seen of a long paste
#define ROWS_LEAST 6u
#define ROWS_MOST 100u
#define COLUMNS_MOST 255u
#define UNDO_SIZE 8192u

static struct {
    bool active;
    unsigned line; // where to begin, from 1; 0: not said
    size_t place;  // where the cursor was last
    uint64_t drawn_us;
} editor;

void editor_set_line(unsigned line) {
    editor.line = line;
}

bool editor_notice(const char *text) {
    if (editor.active) {
        editor_view_message("%s", text);
        editor_view_draw();
    }
    return editor.active;
}

// ---- Screen and memory --------------------------------------------------------------------------

static unsigned clamp(unsigned value, unsigned least, unsigned most) {
    return value < least ? least : value > most ? most : value;
}

// Asks the terminal for the size of its screen: where the cursor gets to when it is sent far out. A
// terminal that does not answer in time has the size that OPTION DISPLAY says. Returns a key that
// came instead.
static int ask_for_size(unsigned *rows, unsigned *columns) {
    console_print("\x1b[999;999H\x1b[6n");
    console_flush();
    int key = keys_read(hal_time_us() + SIZE_WAIT_US);
    *rows = console_rows();
    *columns = console_columns();
    if (key == KEYS_SIZE) {
        *rows = keys_rows();
        *columns = keys_columns();
        key = KEYS_UNKNOWN;
    }
    *rows = clamp(*rows, ROWS_LEAST, ROWS_MOST);
    *columns = clamp(*columns, 20, COLUMNS_MOST);
    return key == KEYS_NO_INPUT ? KEYS_UNKNOWN : key;
}

// Shares the free memory out. False: there is too little.
static bool share_memory(unsigned rows, unsigned columns) {
    size_t size = memory_free();
    if (size < 4 * RESERVE) {
        return false;
    }
    size = (size - RESERVE) / 8 * 8;
    size_t cells = editor_screen_size(rows, columns);
    while (cells > size / 3 && rows > ROWS_LEAST) {
        rows--;
        cells = editor_screen_size(rows, columns);
    }
    if (cells > size / 3) {
        return false;
    }
    size_t undo = size / 8 < UNDO_SIZE ? size / 8 : UNDO_SIZE;
    uint8_t *memory_start = memory.heap + (uintptr_t)memory.heap % sizeof(uint16_t);
    editor_screen_start(memory_start, rows, columns);
    editor_undo_start(memory_start + cells, undo);
    editor_text_start(memory_start + cells + undo, size - cells - undo);
    return true;
}

static void set_first_place(bool is_program) {
    size_t place = is_program ? editor.place : 0;
    if (is_program && editor.line != 0) {
        place = editor_text_place_of_line(editor.line - 1);
    }
    editor_cursor_go(place < editor_text_length() ? place : editor_text_length());
}

// ---- Loop ---------------------------------------------------------------------------------------

static void draw_if_idle(void) {
    uint64_t now_us = hal_time_us();
    if (!console_has_input() || now_us - editor.drawn_us > DRAW_AT_LEAST_US) {
        editor_view_draw();
        editor.drawn_us = now_us;
    }
}

static editor_commands_end_t read_keys(int key, void (*on_break)(void)) {
    editor_commands_end_t end = EDITOR_COMMANDS_GO_ON;
    editor.active = true;
    editor_commands_start(on_break);
    if (key != KEYS_UNKNOWN) {
        end = editor_commands_do(key);
    }
    while (end == EDITOR_COMMANDS_GO_ON) {
        draw_if_idle();
        key = keys_read(UINT64_MAX);
        if (key == KEYS_NO_INPUT && hal_end_of_input()) {
            end = EDITOR_COMMANDS_LEAVE;
        } else {
            end = editor_commands_do(key);
        }
    }
    editor.active = false;
    return end;
}

// Where saving was refused the editor goes on.
static bool is_finished(editor_commands_end_t end, const char *file) {
    if (end == EDITOR_COMMANDS_LEAVE) {
        return true;
    }
    size_t place = editor_cursor.place;
    if (!editor_commands_check()) {
        return false;
    }
    if (editor_store_save(file) != ERR_OK) {
        editor_view_message("Not saved: %s", err_message());
        return false;
    }
    editor.place = file == NULL ? place : editor.place;
    return true;
}

static err_t edit(const char *file, void (*on_break)(void), bool *start) {
    unsigned rows;
    unsigned columns;
    int key = ask_for_size(&rows, &columns);
    if (memory_free() < editor_store_size(file) + ROOM_WANTED) {
        program_release();
    }
    if (!share_memory(rows, columns)) {
        return err_raise(ERR_NO_MEMORY, "%s", "");
    }
    editor_cursor_start((unsigned)options_get(OPTIONS_TAB));
    err_t error = editor_store_load(file);
    if (error != ERR_OK) {
        return error;
    }
    editor_view_start(file, options_get(OPTIONS_COLOUR) != 0);
    set_first_place(file == NULL);
    for (;;) {
        editor_commands_end_t end = read_keys(key, on_break);
        if (is_finished(end, file)) {
            *start = end == EDITOR_COMMANDS_RUN;
            return ERR_OK;
        }
        key = KEYS_UNKNOWN;
    }
}

err_t editor_edit(const char *file, void (*on_break)(void), bool *start) {
    *start = false;
    console_set_full_screen(true);
    console_print("\x1b[?2004h"); // a paste shall come in brackets
    err_t error = edit(file, on_break, start);
    console_print("\x1b[?2004l");
    editor_screen_finish();
    console_set_full_screen(false);
    if (file == NULL) {
        editor.line = 0;
    }
    return error;
}
