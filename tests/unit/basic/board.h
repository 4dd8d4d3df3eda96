// A board for the language's unit tests: a terminal with scripted input, flash in memory, time that
// passes only while the firmware idles.
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "basic/basic.h"
#include "hal/hal.h"

// Everything is as after power-on; the flash is empty.
void board_reset(void);

// Assignments of the next start.
void board_assignments(const basic_assignment_t *assignments, size_t count);

// Starts the language on this board with these rows.
void board_start(const basic_command_t *commands, size_t command_count,
                 const basic_function_t *functions, size_t function_count);

// Bytes the terminal sends next.
void board_type(const char *bytes, size_t length);

// Bytes the terminal sends once the time has come; up to four, in order.
void board_type_at(uint64_t time_us, const char *text);

// What was shown since the last call; zero-terminated.
const char *board_shown(void);

// Runs the prompt on `text` until all of it is taken; returns what was shown, the last prompt
// included.
const char *board_session(const char *text);

// What one line at the prompt prints, without its echo and the prompts. Valid until the next call.
const char *board_answer(const char *line);

typedef struct {
    uint64_t time_us;
    uint64_t blocked_until_us;   // the terminal takes no output before
    bool ticking;                // motion runs: the flash is busy
    unsigned writes;             // calls of hal_console_write() that took something
    unsigned backgrounds;        // calls of the background hook
    void (*on_background)(void); // what it does besides; NULL: nothing
    unsigned breaks;             // calls of on_break
    unsigned clears;             // calls of on_clear
    bool busy;                   // nothing may restart the board
    hal_start_t start_reason;
    unsigned errors;         // calls of on_error
    bool controllable;       // there is something that Ctrl-F acts on
    unsigned controls;       // times Ctrl-F did
    uint64_t control_us;     // when it last did
    unsigned control_writes; // writes until then
    unsigned hold_at_write;  // the terminal sends Ctrl-F when it gets this write
    bool piped;              // input is no terminal
    unsigned statements;
    const struct basic_device *device; // that OPEN knows, set before board_start(); NULL: none
    void (*on_write)(const uint8_t *bytes, size_t size); // somebody listens; NULL: nobody
    int fail_program_after; // pages until programming the flash fails, -1: never
} board_t;

extern board_t board;

// True if `run` restarted the board (2: by the watchdog, 3: into the boot loader).
int board_restarts(void (*run)(void));

#endif
