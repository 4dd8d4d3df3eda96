// Lists a screen at a time. Context: main loop.
#include "pager.h"

#include <stdint.h>

#include "console.h"
#include "hal/hal.h"

static struct {
    bool all;
    size_t rows; // since the last stop
} pager;

void pager_start(bool all) {
    pager.all = all;
    pager.rows = 0;
}

// True: go on.
static bool turn_page(void) {
    console_print("PRESS ANY KEY ...");
    int key;
    while ((key = console_take()) < 0 && !console_break_pending() && !hal_end_of_input()) {
        console_wait(UINT64_MAX);
    }
    bool go_on = key >= 0 && !console_break_pending() && (key | 0x20) != 'q';
    console_print(go_on ? "\r\x1b[K" : "\r\n"); // the prompt always starts a line
    return go_on;
}

bool pager_line(const char *text, size_t length) {
    size_t rows = length == 0 ? 1 : (length + console_columns() - 1) / console_columns();
    if (!pager.all && pager.rows > 0 && pager.rows + rows > console_rows() - 1) {
        pager.rows = 0;
        if (!turn_page()) {
            return false;
        }
    }
    pager.rows += rows;
    console_write(text, length);
    console_new_line();
    return !console_break_pending();
}
