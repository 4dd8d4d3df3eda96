// EDIT: the beginning, the loop and the end. Context: main loop.
#include "editor.h"

#include <stdint.h>

#include "console.h"
#include "editor_commands.h"
#include "editor_cursor.h"
#include "editor_layout.h"
#include "editor_screen.h"
#include "editor_store.h"
#include "editor_text.h"
#include "editor_view.h"
#include "hal/hal.h"
#include "keys.h"
#include "memory.h"
#include "options.h"
#include "program.h"

#define ROOM_WANTED (32u * 1024u) // to write in; if there is less, variables give way
#define SIZE_WAIT_US 150000u      // how long the terminal may take to tell its size
#define DRAW_AT_LEAST_US 300000u  // so often something is seen of a long paste

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

// ---- Loop ---------------------------------------------------------------------------------------

static void set_first_place(bool is_program) {
    size_t place = is_program ? editor.place : 0;
    if (is_program && editor.line != 0) {
        place = editor_text_place_of_line(editor.line - 1);
    }
    editor_cursor_go(place < editor_text_length() ? place : editor_text_length());
}

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
    if (key != KEYS_SIZE && key != KEYS_NO_INPUT) { // typed ahead
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
    editor_view_message("Saving ...");
    editor_view_draw();
    if (editor_store_save(file) != ERR_OK) {
        editor_view_message("Not saved: %s", err_message());
        return false;
    }
    editor.place = file == NULL ? place : editor.place;
    return true;
}

static err_t edit(const char *file, void (*on_break)(void), bool *start) {
    editor_layout_ask_size();
    int key = keys_read(hal_time_us() + SIZE_WAIT_US);
    if (memory_free() < editor_store_size(file) + ROOM_WANTED) {
        program_release();
    }
    if (!editor_layout_start(key == KEYS_SIZE)) {
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
        key = KEYS_NO_INPUT;
    }
}

err_t editor_edit(const char *file, void (*on_break)(void), bool *start) {
    *start = false;
    err_t error = editor_store_check(file); // before anything is drawn
    if (error != ERR_OK) {
        return error;
    }
    console_set_full_screen(true);
    console_print("\x1b[?2004h"); // a paste shall come in brackets
    error = edit(file, on_break, start);
    console_print("\x1b[?2004l");
    editor_screen_finish();
    console_set_full_screen(false);
    if (file == NULL) {
        editor.line = 0;
    }
    return error;
}
