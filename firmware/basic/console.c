// The terminal. Context: main loop.
#include "console.h"

#include <string.h>

#include "hal/hal.h"
#include "watchdog.h"

#define INPUT_SIZE 1024u // power of two; a paste waits here while a statement runs
#define OUTPUT_SIZE 256u
#define CTRL_C 3
#define TAB_WIDTH 8
#define BLOCKED_RETRY_US 1000u
#define RAW_GIVE_UP_US 10000000u // a peer that takes nothing has no Ctrl-C to end the wait

// A program that never reads its input would hide Ctrl-C behind a full ring for ever.
#define UNREAD_LIMIT_US 3000000u

static struct {
    uint8_t input[INPUT_SIZE];
    unsigned received; // free-running
    unsigned taken;
    uint8_t output[OUTPUT_SIZE];
    unsigned output_length;
    unsigned column;
    unsigned rows, columns; // of the screen
    char escape;            // last character of a VT100 sequence being written; 0: none is
    uint8_t break_key;      // ends a program; 0: none
    bool running;
    bool flushing;
    bool polling;
    bool raw;
    bool full_screen;
    bool break_pending;
    bool lost_input;
    uint64_t full_since_us; // 0: the ring is not full
    unsigned seen;          // bytes that came, input or not; free-running
    void (*background)(void);
    uint64_t wake_us; // when the background wants its next turn
    console_control_t on_control;
    int hot_key; // -1: none
    void (*hot_key_pressed)(void);
} console;

void console_start(void (*background)(void), console_control_t on_control) {
    memset(&console, 0, sizeof console);
    console.background = background;
    console.on_control = on_control;
    console.break_key = CTRL_C;
    console.hot_key = -1;
    console_set_size(24, 80);
}

void console_set_break_key(int key) {
    console.break_key = (uint8_t)key;
}

bool console_is_break(int byte) {
    return byte > 0 && byte == (console.running ? console.break_key : CTRL_C);
}

void console_set_full_screen(bool on) {
    console.full_screen = on;
}

void console_set_raw(bool raw) {
    console.raw = raw;
    hal_console_set_raw(raw);
}

bool console_is_busy(void) {
    return console.flushing || console.polling || console.raw;
}

// A break that came together with the line it is to stop. Behind a further line it is left for
// then: a script piped in must not lose the lines between.
static void look_for_break_typed_ahead(void) {
    for (unsigned i = console.taken; i != console.received; i++) {
        uint8_t byte = console.input[i % INPUT_SIZE];
        if (byte == '\r' || byte == '\n') {
            return;
        }
        if (console_is_break(byte)) {
            console.taken = i + 1;
            console.break_pending = true;
            return;
        }
    }
}

void console_set_running(bool running) {
    console.running = running;
    if (running) {
        look_for_break_typed_ahead();
    }
}

bool console_break_pending(void) {
    return console.break_pending;
}

void console_clear_break(void) {
    console.break_pending = false;
}

static unsigned input_room(void) {
    return INPUT_SIZE - (console.received - console.taken);
}

static bool watches_break(void) {
    return (console.running || console.flushing) && !console.raw && !console.full_screen;
}

bool console_offer_control(int byte) {
    return byte >= 0 && byte < ' ' && console.on_control != NULL && console.on_control((char)byte);
}

// True if the byte is one that acts as soon as it comes, ahead of all input, and has done so. Where
// control characters do not come from a keyboard they wait for their turn: what a script does must
// not depend on how far ahead of it the script is read.
static bool acts_at_once(uint8_t byte) {
    if (console.raw || console.full_screen) {
        return false;
    }
    if (console_is_break(byte) && watches_break()) {
        console.break_pending = true;
        console.taken = console.received;
        return true;
    }
    if (byte == console.hot_key && console.running) {
        console.hot_key_pressed();
        return true;
    }
    return byte < ' ' && hal_console_break_is_inband() && console_offer_control(byte);
}

static void receive(uint8_t byte) {
    console.seen++;
    if (acts_at_once(byte)) {
        return;
    }
    if (input_room() == 0) {
        console.lost_input = true;
        return;
    }
    console.input[console.received++ % INPUT_SIZE] = byte;
}

// How many bytes to fetch although the ring may be full.
static unsigned fetch_limit(void) {
    unsigned room = input_room();
    if (room != 0 || !watches_break() || !hal_console_break_is_inband()) {
        console.full_since_us = 0;
        return room;
    }
    uint64_t now = hal_time_us() + 1;
    if (console.full_since_us == 0) {
        console.full_since_us = now;
    }
    return now - console.full_since_us > UNREAD_LIMIT_US ? INPUT_SIZE : 0;
}

void console_poll(void) {
    if (console.polling) { // asked by what a byte just received has set off: the next one waits
        return;
    }
    console.polling = true;
    uint8_t bytes[64];
    size_t count;
    do {
        unsigned limit = fetch_limit();
        count =
            limit == 0 ? 0 : hal_console_read(bytes, limit < sizeof bytes ? limit : sizeof bytes);
        for (size_t i = 0; i < count; i++) {
            receive(bytes[i]);
        }
    } while (count != 0);
    console.polling = false;
}

bool console_has_input(void) {
    if (console.received == console.taken) {
        console_poll();
    }
    return console.received != console.taken;
}

bool console_input_waits(void) {
    return console.received != console.taken;
}

void console_set_hot_key(int byte, void (*pressed)(void)) {
    console.hot_key = byte;
    console.hot_key_pressed = pressed;
}

int console_take(void) {
    if (!console_has_input()) {
        return -1;
    }
    return console.input[console.taken++ % INPUT_SIZE];
}

void console_untake(int byte) {
    console.input[--console.taken % INPUT_SIZE] = (uint8_t)byte;
}

bool console_lost_input(void) {
    bool lost = console.lost_input;
    console.lost_input = false;
    return lost;
}

void console_send(void) {
    if (console.output_length == 0 || console.flushing) {
        return;
    }
    size_t took = hal_console_write(console.output, console.output_length);
    console.output_length -= (unsigned)took;
    memmove(console.output, console.output + took, console.output_length);
}

void console_flush(void) {
    unsigned sent = 0;
    uint64_t give_up_us = console.raw ? hal_time_us() + RAW_GIVE_UP_US : UINT64_MAX;
    console.flushing = true;
    while (sent < console.output_length && !console.break_pending && hal_time_us() < give_up_us) {
        size_t took = hal_console_write(console.output + sent, console.output_length - sent);
        sent += (unsigned)took;
        if (took == 0 || console.running) { // one statement may print for seconds
            console_poll();
        }
        if (took == 0) {
            console.background();
            hal_idle(hal_time_us() + BLOCKED_RETRY_US);
        }
    }
    console.flushing = false;
    console.output_length = 0;
}

// A VT100 sequence moves the cursor, if at all, in a way that its writer knows about.
static void follow_escape(char c) {
    bool opens = console.escape == '\x1b' && c == '[';
    bool parameter = console.escape != '\x1b' && c >= ' ' && c < '@';
    console.escape = opens || parameter ? c : 0;
}

static void put(char c) {
    if (console.output_length == OUTPUT_SIZE) {
        if (console.flushing) { // the background prints while the terminal does not read: no room
            return;
        }
        console_flush();
    }
    console.output[console.output_length++] = (uint8_t)c;
    if (console.escape != 0) {
        follow_escape(c);
    } else if (c == '\x1b') {
        console.escape = c;
    } else if (c == '\r') {
        console.column = 0;
    } else if (c == '\t') {
        console.column += TAB_WIDTH - console.column % TAB_WIDTH;
    } else if (c == '\b') {
        console.column -= console.column > 0;
    } else if ((uint8_t)c >= ' ' && ((uint8_t)c & 0xC0) != 0x80) { // UTF-8: one for a character
        console.column++;
    }
}

void console_write(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        put(text[i]);
    }
}

void console_print(const char *text) {
    console_write(text, strlen(text));
}

void console_new_line(void) {
    console_write("\r\n", 2);
}

void console_fresh_line(void) {
    if (console.column != 0) {
        console_new_line();
    }
}

void console_set_size(unsigned rows, unsigned columns) {
    console.rows = rows;
    console.columns = columns;
}

unsigned console_rows(void) {
    return console.rows;
}

unsigned console_columns(void) {
    return console.columns;
}

void console_set_column(unsigned column) {
    console.column = column;
}

unsigned console_column(void) {
    return console.column;
}

void console_background(void) {
    console.background();
}

void console_wait(uint64_t until_us) {
    unsigned seen = console.seen;
    console_poll();
    console.wake_us = UINT64_MAX;
    console.background(); // may print what came of it
    if (console.output_length != 0) {
        console_flush();
    }
    if (!console.break_pending && console.seen == seen) {
        hal_idle(watchdog_next_us(console.wake_us < until_us ? console.wake_us : until_us));
        console_poll();
    }
}

void console_wake(void) {
    console.seen++;
}

void console_wake_at(uint64_t time_us) {
    if (time_us < console.wake_us) {
        console.wake_us = time_us;
    }
}
