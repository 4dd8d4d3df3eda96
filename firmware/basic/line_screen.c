// A line being typed as it stands on the screen. Context: main loop.
#include "line_screen.h"

#include <stdint.h>
#include <string.h>

#include "base/base.h"
#include "console.h"

// Cells are counted from the start of the first row, rows below each other. A terminal that has
// filled the last cell of a row stays there until the next character comes: that is at_margin.
static struct {
    const char *line;
    size_t origin; // cells in front of the line
    bool at_margin;
} screen;

void line_screen_start(const char *line) {
    screen.line = line;
    screen.origin = console_column();
    screen.at_margin = false;
}

bool line_screen_continues(char byte) {
    return ((uint8_t)byte & 0xC0) == 0x80;
}

static size_t cell_of(size_t place) {
    size_t cells = screen.origin;
    for (size_t i = 0; i < place; i++) {
        cells += !line_screen_continues(screen.line[i]);
    }
    return cells;
}

// The row in which the screen's cursor stands if it is at `place`.
static size_t row_of_cursor(size_t place) {
    return cell_of(place) / console_columns() - (screen.at_margin ? 1 : 0);
}

void line_screen_write(size_t from, size_t to) {
    if (to > from) {
        console_write(screen.line + from, to - from);
        screen.at_margin = cell_of(to) % console_columns() == 0;
    }
}

static void print_sequence(size_t count, char letter) {
    char sequence[16];
    format_text(sequence, sizeof sequence, "\x1b[%u%c", (unsigned)count, letter);
    console_print(sequence);
}

void line_screen_back(size_t from, size_t to) {
    size_t rows = row_of_cursor(from) - cell_of(to) / console_columns();
    size_t cells = cell_of(from) - cell_of(to);
    bool same_row = rows == 0 && !screen.at_margin;
    screen.at_margin = screen.at_margin && from == to;
    if (from == to) {
        return;
    }
    if (same_row) {
        if (cells == 1) {
            console_print("\b");
        } else if (cells > 0) {
            print_sequence(cells, 'D');
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

void line_screen_draw(size_t from, size_t length, size_t cursor) {
    line_screen_write(from, length);
    if (screen.at_margin) { // erasing here would take the last character
        console_print(" \b");
        screen.at_margin = false;
    }
    console_print("\x1b[J");
    line_screen_back(length, cursor);
}

void line_screen_hide(size_t cursor, size_t length, const char *prompt) {
    if (screen.origin != strlen(prompt)) { // something was printed there
        line_screen_write(cursor, length);
        console_new_line();
        return;
    }
    size_t rows = row_of_cursor(cursor);
    if (rows > 0) {
        print_sequence(rows, 'A');
    }
    console_print("\r\x1b[J");
    screen.at_margin = false;
}

bool line_screen_has_rows_below(size_t cursor, size_t length) {
    return cursor < length && cell_of(length) > console_columns();
}
