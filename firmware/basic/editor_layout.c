// How the editor shares memory out.
//
//   | ... heap | undo | text and clipboard | cells of the screen | reserve | scratch ... |
//
// Context: main loop.
#include "editor_layout.h"

#include <stdint.h>

#include "console.h"
#include "editor_screen.h"
#include "editor_text.h"
#include "editor_undo.h"
#include "keys.h"
#include "memory.h"

#define RESERVE 2048u // stays free: what keeping the text needs
#define LEAST (4 * RESERVE)
#define UNDO_SIZE 8192u
#define ROWS_LEAST 6u
#define ROWS_MOST 100u
#define COLUMNS_LEAST 20u
#define COLUMNS_MOST 255u

static struct {
    uint8_t *end;      // of the cells
    size_t cells;      // bytes they have
    size_t cells_most; // bytes they may have
    unsigned rows, columns;
} layout;

static unsigned clamp(unsigned value, unsigned least, unsigned most) {
    return value < least ? least : value > most ? most : value;
}

static bool fits(size_t bytes) {
    return editor_screen_size(layout.rows, layout.columns) <= bytes;
}

// Rows, then columns, give way where there are too many for so many bytes.
static void choose_size(unsigned rows, unsigned columns, size_t bytes) {
    layout.rows = clamp(rows, ROWS_LEAST, ROWS_MOST);
    layout.columns = clamp(columns, COLUMNS_LEAST, COLUMNS_MOST);
    while (layout.rows > ROWS_LEAST && !fits(bytes)) {
        layout.rows--;
    }
    while (layout.columns > COLUMNS_LEAST && !fits(bytes)) {
        layout.columns--;
    }
}

static void start_screen(void) {
    size_t size = editor_screen_size(layout.rows, layout.columns);
    editor_screen_start(layout.end - size, layout.rows, layout.columns);
}

// Where the cursor gets to when it is sent far out.
void editor_layout_ask_size(void) {
    console_print("\x1b[999;999H\x1b[6n");
    console_flush();
}

bool editor_layout_start(bool told) {
    size_t size = memory_free();
    if (size < LEAST) {
        return false;
    }
    size = (size - RESERVE) / 8 * 8;
    layout.cells_most = size / 3;
    choose_size(told ? keys_rows() : console_rows(), told ? keys_columns() : console_columns(),
                layout.cells_most);
    layout.cells = editor_screen_size(layout.rows, layout.columns);
    uint8_t *start = memory.heap + (uintptr_t)memory.heap % sizeof(uint16_t);
    size_t undo = size / 8 < UNDO_SIZE ? size / 8 : UNDO_SIZE;
    layout.end = start + size;
    editor_undo_start(start, undo);
    editor_text_start(start + undo, size - undo - layout.cells);
    start_screen();
    return true;
}

void editor_layout_resize(void) {
    choose_size(keys_rows(), keys_columns(), layout.cells_most);
    size_t size = editor_screen_size(layout.rows, layout.columns);
    if (size > layout.cells && editor_text_shrink(size - layout.cells)) {
        layout.cells = size;
    }
    choose_size(layout.rows, layout.columns, layout.cells);
    start_screen();
}

void editor_layout_refresh(void) {
    editor_layout_ask_size();
    start_screen();
}
