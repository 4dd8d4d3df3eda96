// Keys of a terminal. Context: main loop.
#include "keys.h"

#include <stddef.h>

#include "base/base.h"
#include "console.h"
#include "hal/hal.h"

#define ESCAPE_WAIT_US 100000u // an Escape without a sequence behind it is a key of its own
#define BURST_US 5000u         // keys closer together are not typed
#define PARAMETERS_MAX 3u
#define PARAMETER_LIMIT 10000u

static struct {
    bool skip_line_feed; // the last key was a carriage return
    bool burst;
    uint64_t last_us;
    unsigned rows, columns;
} keys;

// ESC [ number ~
static const struct {
    uint8_t number;
    int key;
} numbered[] = {
    {1, KEYS_HOME},
    {2, KEYS_INSERT},
    {3, KEYS_DELETE},
    {4, KEYS_END},
    {5, KEYS_PAGE_UP},
    {6, KEYS_PAGE_DOWN},
    {7, KEYS_HOME},
    {8, KEYS_END},
    {11, KEYS_F1},
    {12, KEYS_F2},
    {13, KEYS_F3},
    {14, KEYS_F4},
    {15, KEYS_F5},
    {17, KEYS_F6},
    {18, KEYS_F7},
    {19, KEYS_F8},
    {20, KEYS_F9},
    {21, KEYS_F10},
    {23, KEYS_F11},
    {24, KEYS_F12},
    {25, KEYS_F3 | KEYS_SHIFT},
    {26, KEYS_F4 | KEYS_SHIFT},
    {28, KEYS_F5 | KEYS_SHIFT},
    {29, KEYS_F6 | KEYS_SHIFT},
    {31, KEYS_F7 | KEYS_SHIFT},
    {32, KEYS_F8 | KEYS_SHIFT},
    {33, KEYS_F9 | KEYS_SHIFT},
    {34, KEYS_F10 | KEYS_SHIFT},
    {200, KEYS_PASTE_BEGIN},
    {201, KEYS_PASTE_END},
};

// ESC [ letter and ESC O letter
static const struct {
    char letter;
    int key;
} lettered[] = {
    {'A', KEYS_UP},  {'B', KEYS_DOWN}, {'C', KEYS_RIGHT},  {'D', KEYS_LEFT},
    {'F', KEYS_END}, {'H', KEYS_HOME}, {'M', KEYS_RETURN}, {'P', KEYS_F1},
    {'Q', KEYS_F2},  {'R', KEYS_F3},   {'S', KEYS_F4},     {'Z', KEYS_BACK_TAB},
};

static int wait_byte(uint64_t until_us) {
    for (;;) {
        int byte = console_take();
        if (byte >= 0) {
            return byte;
        }
        if (console_break_pending() || hal_end_of_input() || hal_time_us() >= until_us) {
            return -1;
        }
        console_wait(until_us);
    }
}

static int key_of_number(unsigned number) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(numbered); i++) {
        if (numbered[i].number == number) {
            return numbered[i].key;
        }
    }
    return KEYS_UNKNOWN;
}

static int key_of_letter(int letter) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(lettered); i++) {
        if (lettered[i].letter == letter) {
            return lettered[i].key;
        }
    }
    return KEYS_UNKNOWN;
}

// xterm's second parameter: 1 + 1 for Shift + 2 for Alt + 4 for Ctrl.
static int modified(int key, unsigned parameter) {
    unsigned bits = parameter > 0 ? parameter - 1 : 0;
    return key | (bits & 1 ? KEYS_SHIFT : 0) | (bits & 2 ? KEYS_ALT : 0) |
           (bits & 4 ? KEYS_CTRL : 0);
}

typedef struct {
    unsigned parameters[PARAMETERS_MAX];
    int final; // -1: it was cut off
} sequence_t;

// The rest of a sequence behind ESC [ or ESC O. A control character cannot belong to it: it is
// left.
static void read_sequence(sequence_t *sequence, uint64_t until_us) {
    unsigned place = 0;
    *sequence = (sequence_t){.final = -1};
    for (;;) {
        int byte = wait_byte(until_us);
        if (byte >= '0' && byte <= '9' && place < PARAMETERS_MAX) {
            unsigned *number = &sequence->parameters[place];
            *number = *number < PARAMETER_LIMIT ? *number * 10 + (unsigned)(byte - '0') : *number;
        } else if (byte == ';') {
            place++;
        } else if (byte >= '@' || byte == '$') { // rxvt ends Shift sequences with a dollar
            sequence->final = byte;
            return;
        } else if (byte < ' ') {
            if (byte >= 0) {
                console_untake(byte);
            }
            return;
        }
    }
}

static int key_of_sequence(const sequence_t *sequence) {
    const unsigned *parameters = sequence->parameters;
    switch (sequence->final) {
    case '~':
        return modified(key_of_number(parameters[0]), parameters[1]);
    case '^':
        return key_of_number(parameters[0]) | KEYS_CTRL;
    case '$':
        return key_of_number(parameters[0]) | KEYS_SHIFT;
    case '@':
        return key_of_number(parameters[0]) | KEYS_CTRL | KEYS_SHIFT;
    case 'R': // also F3 with a modifier, whose first parameter is 1
        if (parameters[0] > 1 && parameters[1] > 1) {
            keys.rows = parameters[0];
            keys.columns = parameters[1];
            return KEYS_SIZE;
        }
        return modified(KEYS_F3, parameters[1]);
    default:
        return modified(key_of_letter(sequence->final), parameters[1]);
    }
}

// The Linux console's F1 to F5: ESC [ [ A ...
static int read_console_key(uint64_t until_us) {
    int byte = wait_byte(until_us);
    if (byte >= 'A' && byte <= 'E') {
        return KEYS_F1 + (byte - 'A');
    }
    if (byte >= 0) {
        console_untake(byte);
    }
    return KEYS_UNKNOWN;
}

// What follows an Escape. A byte that cannot belong to a sequence is left for the next key.
static int read_escape(void) {
    uint64_t until_us = hal_time_us() + ESCAPE_WAIT_US;
    int alt = 0;
    int byte = wait_byte(until_us);
    if (byte == KEYS_ESCAPE) { // some terminals put it before the sequence for Alt
        alt = KEYS_ALT;
        byte = wait_byte(until_us);
    }
    if (byte != '[' && byte != 'O') {
        if (byte >= 0) {
            console_untake(byte);
        }
        return KEYS_ESCAPE;
    }
    sequence_t sequence;
    read_sequence(&sequence, until_us);
    if (sequence.final == '[' && byte == '[') {
        return read_console_key(until_us);
    }
    int key = key_of_sequence(&sequence);
    bool known = key != KEYS_SIZE && (key & 0xFFF) != KEYS_UNKNOWN;
    return known ? key | alt : key & 0xFFF;
}

static int decode(int byte) {
    return byte == KEYS_ESCAPE ? read_escape() : byte;
}

int keys_take(void) {
    int byte = console_take();
    return byte < 0 ? KEYS_NO_INPUT : decode(byte);
}

int keys_read(uint64_t until_us) {
    for (;;) {
        bool waited_for_us = console_has_input();
        int byte = wait_byte(until_us);
        if (byte < 0) {
            return KEYS_NO_INPUT;
        }
        bool second_of_pair = byte == KEYS_LINE_FEED && keys.skip_line_feed;
        keys.skip_line_feed = byte == KEYS_RETURN;
        if (second_of_pair) {
            continue;
        }
        int key = decode(byte == KEYS_LINE_FEED ? KEYS_RETURN : byte);
        uint64_t since_us = hal_time_us() - keys.last_us;
        keys.last_us += since_us;
        // Time that stands still, as in a simulation that waits for input, tells nothing.
        bool quick = since_us > 0 && since_us < BURST_US;
        keys.burst = waited_for_us || quick || console_has_input();
        return key;
    }
}

bool keys_in_burst(void) {
    return keys.burst;
}

unsigned keys_rows(void) {
    return keys.rows;
}

unsigned keys_columns(void) {
    return keys.columns;
}
