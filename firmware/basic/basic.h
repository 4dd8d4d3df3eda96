// The language: an MMBasic-style interpreter and its console. It knows the syntax and the general
// statements; the words of the product (STEPPER, TMC22xx, PEEK(STEPPER ...)) are rows of a table
// that the caller brings along. The face of firmware/basic. Context: main loop.
#ifndef BASIC_H
#define BASIC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

// ---- Values -------------------------------------------------------------------------------------

typedef enum { BASIC_FLOAT, BASIC_INTEGER, BASIC_STRING } basic_type_t;

typedef struct {
    const char *text; // not zero-terminated; belongs to the interpreter, valid during the call
    size_t length;
} basic_text_t;

typedef struct {
    basic_type_t type;
    union {
        double number;
        int64_t integer;
        basic_text_t text;
    };
} basic_value_t;

// ---- Commands -----------------------------------------------------------------------------------

// How an argument is written, and behind the arrow the fields of basic_arg_t it fills.
typedef enum {
    BASIC_ARG_NUMBER,  // numeric expression -> number
    BASIC_ARG_INTEGER, // the same, rounded half away from zero -> integer, number
    BASIC_ARG_TEXT,    // string expression -> text
    // One of the words in `choices`, bare or as a string expression; a number where the words are
    // numbers -> integer (its index), text
    BASIC_ARG_CHOICE,
    BASIC_ARG_WORD, // a bare word, or a string expression -> text
    // GPn, "GPn", or a number: a GPIO number, or the board's with BASIC_ARG_BOARD_NUMBER; see
    // BASIC_PIN_NUMBERS. With BASIC_ARG_OPTIONAL a literal 0 or blank means no pin
    // -> integer (GPIO or PINS_NONE)
    BASIC_ARG_PIN,
    // The name of a SUB without parameters, bare or as a string expression; a literal 0 or blank
    // means none -> integer (a basic_routine_t)
    BASIC_ARG_ROUTINE,
    // The last one of a list, taking all that follows: numbers, or one string, or all of an array,
    // name() -> data, integer (how many numbers it is)
    BASIC_ARG_DATA,
    // What is to be written into: a number, a string, or all of an array of numbers, name()
    // -> data, integer (how many numbers fit)
    BASIC_ARG_STORE,
    // The rest of the statement as typed, comment included; ends at a colon outside quotes,
    // parentheses and comments -> text
    BASIC_ARG_RAW,
} basic_arg_kind_t;

enum {
    BASIC_ARG_OPTIONAL = 1 << 0,  // may be left out or left blank
    BASIC_ARG_DEFAULT = 1 << 1,   // if left out, `fallback` is delivered and `given` stays false
    BASIC_ARG_REPEAT = 1 << 2,    // this one and those behind it repeat as a group, 0 or more times
    BASIC_ARG_ABOVE_MIN = 1 << 3, // the minimum itself is not allowed
    BASIC_ARG_BOARD_NUMBER = 1 << 4, // PIN: a bare number is the one printed beside the board's pin
    // CHOICE: of several rows with one name, which stand together, a bare word here that is one of
    // `choices` takes this row. A row without such an argument is taken if no other is.
    BASIC_ARG_SELECTS = 1 << 5
};

// One argument of a command: parsing, range check, error text, HELP and the reference page in one
// row.
typedef struct {
    const char *name; // as in the reference, e.g. "steps_per_unit"
    basic_arg_kind_t kind;
    unsigned flags;
    double min, max;  // NUMBER and INTEGER; both 0: no limits
    double fallback;  // with BASIC_ARG_DEFAULT, NUMBER and INTEGER
    const char *unit; // "mm", "mm/s^2"; NULL: none
    // Words with a bar between, e.g. "X|Y|Z|A". CHOICE: what there is to choose from. NUMBER and
    // INTEGER: words, + and - among them, that may stand instead of the number; `text` and
    // `integer` are then as for a CHOICE, and `text` is empty for a number.
    const char *choices;
    const char *help; // a short sentence without a full stop
} basic_arg_spec_t;

// What a BASIC_ARG_DATA or a BASIC_ARG_STORE stands for; see basic_data_number().
typedef struct {
    const void *values; // the interpreter's
    size_t count;       // as they were written, commas between
} basic_data_t;

// One argument as delivered to a handler; the array always has a row for each row of the spec (and
// for each repetition), with given == false where it was left out.
typedef struct {
    bool given;
    double number;
    int64_t integer;
    union {
        basic_text_t text;
        basic_data_t data;
    };
} basic_arg_t;

#define BASIC_ARGS_MAX 24

// Carries the command out. Anything but ERR_OK ends the statement with err_message().
typedef err_t (*basic_run_t)(const basic_arg_t *args, size_t count);

typedef struct {
    const char *name; // words with one blank between, in capitals: "STEPPER AXIS"
    const basic_arg_spec_t *args;
    size_t arg_count;
    basic_run_t run;
    const char *help; // one sentence for HELP and the reference page
} basic_command_t;

// An assignment to a function, as PIN(GP2) = 1: a row with the function's name, whose args[0] is
// the value behind the equals sign and whose further arguments are those in the parentheses.
typedef basic_command_t basic_assignment_t;

// Computes a function's value. `result` arrives as integer 0; a text result must stay valid until
// the next call of the same function.
typedef err_t (*basic_evaluate_t)(const basic_arg_t *args, size_t count, basic_value_t *result);

typedef struct {
    const char *name;    // in capitals: "PEEK"
    const char *keyword; // a first word inside the parentheses that selects this row, followed by a
                         // blank instead of a comma: PEEK(STEPPER X) has "STEPPER". NULL: none
    const basic_arg_spec_t *args;
    size_t arg_count;
    basic_evaluate_t evaluate;
    const char *help;
} basic_function_t;

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
    const basic_command_t *commands; // of two rows that match the longer name wins
    size_t command_count;
    const basic_function_t *functions;
    size_t function_count;
    const basic_assignment_t *assignments; // one row for each name
    size_t assignment_count;
    // Called every few statements and whenever something waits; NULL: none.
    void (*background)(void);
    // Called once when the user pressed Ctrl-C; NULL: none.
    void (*on_break)(void);
    // Variables and all that a program has set are being forgotten: RUN, NEW, a new program. NULL:
    // none.
    void (*on_clear)(void);
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

#endif
