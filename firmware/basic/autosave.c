// AUTOSAVE. The new text gathers in the free part of the arena, so that the old program stays until
// the new one is complete. Context: main loop.
#include "autosave.h"

#include <string.h>

#include "console.h"
#include "hal/hal.h"
#include "line_editor.h"
#include "memory.h"
#include "program.h"

#define RESERVE 1024u

static struct {
    char *text;
    size_t length;
    size_t size;
    bool has_all; // the old program's code and variables have given way
    err_t error;  // met on the way; the rest of the paste is still taken in
} incoming;

static void measure(void) {
    incoming.text = (char *)memory.heap;
    incoming.size = memory_free() > RESERVE ? memory_free() - RESERVE : 0;
}

// What has come so far moves down to where the old program's code was.
static void take_all_memory(void) {
    const char *text = incoming.text;
    program_release();
    measure();
    memmove(incoming.text, text, incoming.length);
    incoming.has_all = true;
}

static bool make_room(size_t size) {
    if (incoming.length + size > incoming.size && !incoming.has_all) {
        take_all_memory();
    }
    if (incoming.length + size > incoming.size) {
        incoming.error = ERR_NO_MEMORY;
    }
    return incoming.error == ERR_OK;
}

static void append(const char *line, size_t length) {
    if (make_room(length + 1)) {
        memcpy(incoming.text + incoming.length, line, length);
        incoming.length += length;
        incoming.text[incoming.length++] = '\n';
    }
}

static void begin_with_program(void) {
    size_t length = program_length();
    if (length != 0 && make_room(length + 1)) {
        memcpy(incoming.text, program_text(), length);
        incoming.length = length;
        if (incoming.text[length - 1] != '\n') {
            incoming.text[incoming.length++] = '\n';
        }
    }
}

// True when the text is complete, false when it was given up.
static bool read_lines(bool *start) {
    const line_editor_options_t options = {.prompt = "", .finish_keys = true, .keep_tabs = true};
    *start = false;
    for (;;) {
        const char *line;
        size_t length;
        line_editor_result_t result = line_editor_read(&options, &line, &length);
        switch (result) {
        case LINE_EDITOR_LINE:
            append(line, length);
            break;
        case LINE_EDITOR_TOO_LONG:
            if (incoming.error == ERR_OK) {
                incoming.error = ERR_LINE_TOO_LONG;
            }
            break;
        case LINE_EDITOR_FINISHED:
        case LINE_EDITOR_FINISHED_RUN:
            *start = result == LINE_EDITOR_FINISHED_RUN;
            if (length > 0) {
                append(line, length);
            }
            return true;
        case LINE_EDITOR_END: // a file without a Ctrl-Z at its end
            return true;
        case LINE_EDITOR_BREAK:
            return false;
        }
    }
}

err_t autosave_read(bool behind, bool *start) {
    incoming.length = 0;
    incoming.has_all = false;
    incoming.error = ERR_OK;
    measure();
    if (behind) {
        begin_with_program();
    }
    if (!hal_storage_is_writable()) {
        incoming.error = ERR_STORAGE_BUSY;
        console_print("Motion is under way: text up to Ctrl-Z or Ctrl-C is dropped");
        console_new_line();
    }
    if (!read_lines(start)) {
        console_clear_break();
        return ERR_OK;
    }
    if (incoming.error != ERR_OK) {
        return err_raise(incoming.error, NULL);
    }
    return program_set_text(incoming.text, incoming.length);
}
