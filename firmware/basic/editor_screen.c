// The screen of a VT100 terminal as cells. Context: main loop.
#include "editor_screen.h"

#include <stdint.h>
#include <string.h>

#include "base/base.h"
#include "console.h"

#define LOOK_SHIFT 13
#define CODE_MASK 0x1FFFu
#define UPPER_CODES                                                                                \
    0x2000 // punctuation, arrows, mathematics, frames: up to 0x2FFF, kept from 0x1000 on
#define UPPER_CELLS 0x1000
#define CODES_END 0x590   // scripts beyond are not a cell a letter
#define MARKS_BEGIN 0x300 // marks that stand on the letter before
#define MARKS_END 0x370
#define BLANK ((uint16_t)' ')
#define ERASE_WORTH 4 // blanks at the end of a row that are erased rather than written
#define MOVE_WORTH 4  // cells that are written again rather than jumped over

typedef uint16_t cell_t; // character and look

static const char *const looks[] = {
    [EDITOR_SCREEN_TEXT] = "\x1b[0m",       [EDITOR_SCREEN_INVERSE] = "\x1b[0;7m",
    [EDITOR_SCREEN_KEYWORD] = "\x1b[0;36m", [EDITOR_SCREEN_STRING] = "\x1b[0;35m",
    [EDITOR_SCREEN_NUMBER] = "\x1b[0;32m",  [EDITOR_SCREEN_COMMENT] = "\x1b[0;33m",
};

static struct {
    cell_t *cells; // what the terminal shows, row by row; behind it the row being put together
    unsigned rows;
    unsigned columns; // of the terminal, the last included
    unsigned filled;  // cells of the row being put together
    // The terminal's cursor and look as they are.
    unsigned row, column;
    unsigned look;
    bool hidden;
} screen;

size_t editor_screen_size(unsigned rows, unsigned columns) {
    return (size_t)(rows + 1) * columns * sizeof(cell_t);
}

static cell_t *row_cells(unsigned row) {
    return screen.cells + (size_t)row * screen.columns;
}

static void blank(cell_t *cells, size_t count) {
    for (size_t i = 0; i < count; i++) {
        cells[i] = BLANK;
    }
}

void editor_screen_start(void *memory, unsigned rows, unsigned columns) {
    screen.cells = memory;
    screen.rows = rows;
    screen.columns = columns;
    screen.row = screen.column = screen.filled = 0;
    screen.look = EDITOR_SCREEN_TEXT;
    screen.hidden = false;
    blank(screen.cells, (size_t)(rows + 1) * columns);
    console_print("\x1b[0m\x1b[2J\x1b[H");
}

unsigned editor_screen_rows(void) {
    return screen.rows;
}

unsigned editor_screen_columns(void) {
    return screen.columns - 1;
}

// ---- A row --------------------------------------------------------------------------------------

// True if a cell can show the character.
static bool has(int code) {
    return (code >= ' ' && code < 0x7F) || (code >= 0xA0 && code < MARKS_BEGIN) ||
           (code >= MARKS_END && code < CODES_END) ||
           (code >= UPPER_CODES + 0x10 && code < UPPER_CODES + 0x1000);
}

void editor_screen_put(int code, editor_screen_look_t look) {
    if (screen.filled == screen.columns - 1) {
        return;
    }
    if (!has(code)) {
        code = '?';
    }
    unsigned cell = (unsigned)(code >= UPPER_CODES ? code - UPPER_CODES + UPPER_CELLS : code);
    row_cells(screen.rows)[screen.filled++] = (cell_t)(cell | (unsigned)look << LOOK_SHIFT);
}

void editor_screen_print(const char *text, editor_screen_look_t look) {
    for (; *text != '\0'; text++) {
        editor_screen_put(*text, look);
    }
}

void editor_screen_fill(unsigned column, editor_screen_look_t look) {
    while (screen.filled < column && screen.filled < screen.columns - 1) {
        editor_screen_put(' ', look);
    }
}

unsigned editor_screen_column(void) {
    return screen.filled;
}

// ---- Sending ------------------------------------------------------------------------------------

static void print_sequence(unsigned first, unsigned second, char letter) {
    char text[24];
    if (second != 0) {
        format_text(text, sizeof text, "\x1b[%u;%u%c", first, second, letter);
    } else {
        format_text(text, sizeof text, "\x1b[%u%c", first, letter);
    }
    console_print(text);
}

// A cursor that jumps about while rows are drawn is a nuisance.
static void hide_cursor(void) {
    if (!screen.hidden) {
        console_print("\x1b[?25l");
        screen.hidden = true;
    }
}

static void set_look(unsigned look) {
    if (look != screen.look) {
        console_print(looks[look]);
        screen.look = look;
    }
}

static void send_cell(cell_t cell) {
    set_look(cell >> LOOK_SHIFT);
    unsigned code = cell & CODE_MASK;
    code = code >= UPPER_CELLS ? code - UPPER_CELLS + UPPER_CODES : code;
    char bytes[3];
    size_t count = 1;
    if (code < 0x80) {
        bytes[0] = (char)code;
    } else if (code < 0x800) {
        bytes[0] = (char)(0xC0 | code >> 6);
        bytes[1] = (char)(0x80 | (code & 0x3F));
        count = 2;
    } else {
        bytes[0] = (char)(0xE0 | code >> 12);
        bytes[1] = (char)(0x80 | (code >> 6 & 0x3F));
        bytes[2] = (char)(0x80 | (code & 0x3F));
        count = 3;
    }
    console_write(bytes, count);
    screen.column++;
}

static void go(unsigned row, unsigned column) {
    if (row == screen.row && column == screen.column) {
        return;
    }
    if (row == screen.row && column == 0) {
        console_print("\r");
    } else if (row == screen.row && column + 1 == screen.column) {
        console_print("\b");
    } else if (row == screen.row && column > screen.column) {
        print_sequence(column - screen.column, 0, 'C');
    } else {
        print_sequence(row + 1, column + 1, 'H');
    }
    screen.row = row;
    screen.column = column;
}

// Goes to a cell that has to change. A few cells on the way there are written again, if that takes
// no change of look.
static void approach(unsigned row, unsigned column) {
    hide_cursor();
    const cell_t *cells = row_cells(row);
    bool near = row == screen.row && column > screen.column && column - screen.column <= MOVE_WORTH;
    for (unsigned i = screen.column; near && i < column; i++) {
        near = cells[i] >> LOOK_SHIFT == screen.look && (cells[i] & CODE_MASK) < 0x80;
    }
    while (near && screen.column < column) {
        send_cell(cells[screen.column]);
    }
    go(row, column);
}

static unsigned used_columns(const cell_t *cells) {
    unsigned end = screen.columns - 1;
    while (end > 0 && cells[end - 1] == BLANK) {
        end--;
    }
    return end;
}

void editor_screen_end_row(unsigned row) {
    cell_t *new_cells = row_cells(screen.rows);
    cell_t *cells = row_cells(row);
    blank(new_cells + screen.filled, screen.columns - screen.filled);
    screen.filled = 0;
    unsigned end = used_columns(new_cells);
    unsigned old_end = used_columns(cells);
    bool erase = old_end >= end + ERASE_WORTH;
    unsigned send_end = erase || old_end < end ? end : old_end;
    for (unsigned i = 0; i < send_end; i++) {
        if (new_cells[i] != cells[i]) {
            approach(row, i);
            send_cell(new_cells[i]);
            cells[i] = new_cells[i];
        }
    }
    if (erase) {
        approach(row, end);
        set_look(EDITOR_SCREEN_TEXT);
        console_print("\x1b[K");
        blank(cells + end, old_end - end);
    }
}

void editor_screen_shift(unsigned first, unsigned end, int lines) {
    unsigned count = (unsigned)(lines < 0 ? -lines : lines);
    unsigned kept = end - first - count;
    if (lines == 0 || count >= end - first) {
        return;
    }
    hide_cursor();
    set_look(EDITOR_SCREEN_TEXT);
    print_sequence(first + 1, end, 'r'); // only these rows move
    print_sequence(first + 1, 1, 'H');
    print_sequence(count, 0, lines < 0 ? 'M' : 'L');
    console_print("\x1b[r\x1b[H"); // the first does this as well, on most terminals
    screen.row = screen.column = 0;
    size_t bytes = (size_t)kept * screen.columns * sizeof(cell_t);
    if (lines < 0) {
        memmove(row_cells(first), row_cells(first + count), bytes);
        blank(row_cells(end - count), (size_t)count * screen.columns);
    } else {
        memmove(row_cells(first + count), row_cells(first), bytes);
        blank(row_cells(first), (size_t)count * screen.columns);
    }
}

void editor_screen_set_cursor(unsigned row, unsigned column) {
    go(row, column);
    console_print("\x1b[?25h");
    screen.hidden = false;
    console_flush();
}

void editor_screen_finish(void) {
    console_print("\x1b[0m\x1b[2J\x1b[H\r");
    console_flush();
}
