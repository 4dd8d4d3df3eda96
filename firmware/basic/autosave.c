// AUTOSAVE. The new text gathers in the free part of the arena, so that the old program stays until the
// new one is complete. Context: main loop.
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
    err_t error; // met on the way; the rest of the paste is still taken in
} incoming;

static void append(const char *line, size_t length) {
    if (incoming.length + length + 1 > incoming.size) {
        incoming.error = ERR_NO_MEMORY;
        return;
    }
    memcpy(incoming.text + incoming.length, line, length);
    incoming.length += length;
    incoming.text[incoming.length++] = '\n';
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

err_t autosave_read(bool *start) {
    incoming.text = (char *)memory.heap;
    incoming.length = 0;
    incoming.size = memory_free() > RESERVE ? memory_free() - RESERVE : 0;
    incoming.error = ERR_OK;
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
        return err_raise(incoming.error, "%s", "");
    }
    return program_set_text(incoming.text, incoming.length);
}
