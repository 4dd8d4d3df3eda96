// The language: an MMBasic-style interpreter and its console. It knows the syntax and the general
// statements; the words of the product (STEPPER, TMC22xx, PEEK(STEPPER ...)) are rows of a table
// that the caller brings along. The face of firmware/basic. Context: main loop.
#ifndef BASIC_H
#define BASIC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "basic/basic_rows.h"

// ---- Events -------------------------------------------------------------------------------------

// Interrupts of a program: an event calls a SUB at the start of the next statement, or while PAUSE
// waits; never inside the SUB of another one. They live while a program (or a line) runs.

typedef uint16_t basic_routine_t; // a SUB of the program, valid while it runs; 0: none

// Those that wait are served in turn.
enum {
    BASIC_EVENT_TICK1,
    BASIC_EVENT_TICK2,
    BASIC_EVENT_TICK3,
    BASIC_EVENT_TICK4,
    BASIC_EVENT_KEY,
    BASIC_EVENT_KEY_CODE,
    BASIC_EVENT_PRODUCT, // the product numbers its own from here
    BASIC_EVENTS = 32
};

// The SUB of this name, for names that come in a string. Errors: there is none, or it has
// parameters.
err_t basic_find_routine(basic_text_t name, basic_routine_t *routine);

// Which SUB the event calls; 0: none, and an event that waits is forgotten.
void basic_set_event(unsigned event, basic_routine_t routine);

// The event has happened. Has no effect without a SUB; several before it is served are one.
// Context: main loop, for instance the background.
void basic_raise_event(unsigned event);

// ---- Start --------------------------------------------------------------------------------------

typedef struct {
    void *arena; // all memory of variables, strings and the program; nothing else is allocated
    size_t arena_size;
    // The product's words: tables of rows, in the order in which HELP lists them.
    const basic_rows_t *const *tables;
    size_t table_count;
    // Called every few statements and whenever something waits; NULL: none.
    void (*background)(void);
    // Called once when the user pressed Ctrl-C; NULL: none.
    void (*on_break)(void);
    // Variables and all that a program has set are being forgotten: RUN, NEW, a new program. NULL:
    // none.
    void (*on_clear)(void);
    // RUN or NEW: the next program is to find the product as after power-up. Comes before on_clear;
    // may wait with basic_wait(). NULL: none.
    void (*on_new)(void);
    // An error has ended a program (not a line at the prompt), before it is printed. NULL: none.
    void (*on_error)(void);
    // Asked before CPU RESTART and the boot loader: an error that is raised refuses it. NULL:
    // always.
    err_t (*may_restart)(void);
    // Called as soon as a control character other than Ctrl-C comes from the terminal: in the
    // middle of a statement, of output or of a line being typed. True: it was meant for the product
    // and is no input. May call basic_notice(); must not raise errors. NULL: all are input.
    bool (*on_control)(char c);
    const char *banner; // first line that basic_start() prints; behind it: what memory there is
    // What OPEN takes besides files (basic_device.h); NULL with a count of 0: files only.
    const struct basic_device *const *devices;
    size_t device_count;
} basic_config_t;

// Takes the configuration (which must stay valid), clears everything and prints the banner.
void basic_start(const basic_config_t *config);

// Carries out what a board does at power-up before the prompt: MM.STARTUP of the stored program,
// and the program itself if OPTION AUTORUN is on. Not after a start because of a fault, or if
// Ctrl-C comes first.
void basic_boot(void);

// Runs `source`, whose lines end with \n and which has to stay valid, to its end. Prints the error
// if there is one.
err_t basic_run_program(const char *source, size_t length);

// One turn of the prompt: shows it, waits for a line, carries it out, prints an error if there is
// one. False if there is no line and no more input can come.
bool basic_prompt(void);

// ---- For command handlers -----------------------------------------------------------------------

// Prints to the console; a bare \n in the format becomes \r\n.
void basic_printf(const char *format, ...) __attribute__((format(printf, 1, 2)));

// A line from outside the running statement (an event of the machine). It stands on a line of its
// own: a line being typed is taken away and drawn again below. Shown at the next place where that
// can be done, in the middle of output not before the statement ends.
void basic_notice(const char *format, ...) __attribute__((format(printf, 1, 2)));

// The number at `index`, below arg->integer, of a BASIC_ARG_DATA; of a string it is the byte there.
// Rounded, and the nearest if it is beyond 64 bits.
int64_t basic_data_number(const basic_arg_t *arg, size_t index);

// Writes the number at `index`, below arg->integer, of a BASIC_ARG_STORE; a string ends behind it
// and takes the low eight bits.
void basic_store_number(const basic_arg_t *arg, size_t index, int64_t number);

// A setting of the product that outlives power-off: what was set, or the fallback. The name is that
// of the command that sets it, without OPTION. Quick enough to be asked each time.
int64_t basic_option(const char *name, int64_t fallback);

// Errors: motion is under way, no room; the setting is as it was.
err_t basic_set_option(const char *name, int64_t value);

// A setting of the product with a meaning here: what a bare number stands for where a pin is
// wanted. One rule for all rows, or (if it was not set) what each row says.
#define BASIC_PIN_NUMBERS "PIN NUMBERS"
enum { BASIC_PIN_NUMBERS_GPIO, BASIC_PIN_NUMBERS_BOARD, BASIC_PIN_NUMBERS_BY_ROW };

// True if the user pressed Ctrl-C and the statement should end; a handler that waits must ask.
bool basic_break_pending(void);

// Sleeps until something happens or `until_us`, while the background and the console go on. False
// if the user pressed Ctrl-C and the statement should end.
bool basic_wait(uint64_t until_us);

// Memory for the rest of the statement, zeroed and 8-aligned. NULL: there is not so much.
void *basic_scratch(size_t size);

// For the background hook: there is more to do, so nothing is to sleep before it is called again.
void basic_wake(void);

// For the background hook: it wants its next turn at this time at the latest, however long whoever
// waits would sleep. Holds for one turn.
void basic_wake_at(uint64_t time_us);

#endif
