// Keys of a terminal: bytes as they are, and the sequences that PuTTY, xterm, TeraTerm, screen,
// minicom, rxvt, the Linux console and VS Code send for the others. Context: main loop.
#ifndef BASIC_KEYS_H
#define BASIC_KEYS_H

#include <stdbool.h>
#include <stdint.h>

// A key is a byte, or one of these. The low byte is what INKEY$ returns for it, as in MMBasic.
enum {
    KEYS_DELETE = 0x17F,
    KEYS_UP,
    KEYS_DOWN,
    KEYS_LEFT,
    KEYS_RIGHT,
    KEYS_INSERT,
    KEYS_HOME = 0x186,
    KEYS_END,
    KEYS_PAGE_UP,
    KEYS_PAGE_DOWN,
    KEYS_F1 = 0x191, // KEYS_F2 ... KEYS_F12 follow
    KEYS_F2,
    KEYS_F3,
    KEYS_F4,
    KEYS_F5,
    KEYS_F6,
    KEYS_F7,
    KEYS_F8,
    KEYS_F9,
    KEYS_F10,
    KEYS_F11,
    KEYS_F12,
    KEYS_BACK_TAB = 0x19F,
    KEYS_PASTE_BEGIN = 0x200, // brackets around pasted text, if the terminal was asked for them
    KEYS_PASTE_END,
    KEYS_SIZE,     // the terminal has told the size of its screen: keys_rows(), keys_columns()
    KEYS_UNKNOWN,  // a sequence that means nothing here
    KEYS_NO_INPUT, // none in time, a break, or the end of all input

    KEYS_SHIFT = 0x1000, // added to keys that have sequences
    KEYS_CTRL = 0x2000,
    KEYS_ALT = 0x4000,

    KEYS_TAB = 9,
    KEYS_LINE_FEED = 10,
    KEYS_RETURN = 13,
    KEYS_ESCAPE = 27,
};

// 'C' as in Ctrl-C.
#define KEYS_CONTROL(letter) ((letter) & 0x1F)

// The next key, waited for until `until_us`. CR, LF and CR LF are all one KEYS_RETURN.
int keys_read(uint64_t until_us);

// The next key if a byte is there, else KEYS_NO_INPUT; line ends as they come.
int keys_take(void);

// True if the last key came together with others, as in a paste: faster than fingers are.
bool keys_in_burst(void);

// What the terminal told last.
unsigned keys_rows(void);
unsigned keys_columns(void);

#endif
