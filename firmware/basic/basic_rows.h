// The words of a product as rows: commands, functions and assignments with their arguments.
// Parsing, range checks, error texts, HELP and the reference page all come from them. Part of
// basic.h. Context: main loop.
#ifndef BASIC_BASIC_ROWS_H
#define BASIC_BASIC_ROWS_H

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
    BASIC_ARG_SELECTS = 1 << 5,
    // WORD: a number will do as well, within min and max -> integer, number; `text` is empty then.
    // A bare word stays a word, whatever variables there are.
    BASIC_ARG_OR_NUMBER = 1 << 6
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
    const char *keyword; // first words inside the parentheses that select this row, followed by a
                         // blank instead of a comma: PEEK(STEPPER X) has "STEPPER". NULL: none. Of
                         // two that match the longer one wins
    const basic_arg_spec_t *args;
    size_t arg_count;
    basic_evaluate_t evaluate;
    const char *help;
} basic_function_t;

// ---- Tables -------------------------------------------------------------------------------------

// Rows that belong together. Of two commands that match the longer name wins; commands of one name
// stand together in one table; an assignment has one row for each name. All tables together have
// at most 255 commands and 64 functions.
typedef struct {
    const basic_command_t *commands;
    size_t command_count;
    const basic_function_t *functions;
    size_t function_count;
    const basic_assignment_t *assignments;
    size_t assignment_count;
} basic_rows_t;

#endif
