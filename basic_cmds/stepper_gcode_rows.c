// Rows of the commands that take G-code. Context: main loop.
#include "basic_cmds/control.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"

static const basic_arg_spec_t gc_args[] = {
    {"gcode", BASIC_ARG_RAW, .help = "a line of G-code as it is"},
};

static const basic_arg_spec_t gs_args[] = {
    {"string$", BASIC_ARG_TEXT, .help = "a line of G-code as a string expression"},
};

static const basic_arg_spec_t gcode_args[] = {
    {"code", BASIC_ARG_WORD, OPTIONAL, .help = "G0, G1, ...; blank repeats the last motion"},
    {"letter", BASIC_ARG_WORD, BASIC_ARG_REPEAT, .help = "X, Y, Z, A, F or P"},
    {"value", BASIC_ARG_NUMBER, .help = "its value"},
};

static const basic_command_t commands[] = {
    {"STEPPER GC", ARGS(gc_args), control_gcode_text, "Queues a line of G-code"},
    {"STEPPER GS", ARGS(gs_args), control_gcode_text, "Queues a line of G-code from a string"},
    {"STEPPER GCODE", ARGS(gcode_args), control_gcode_words,
     "Queues G-code given as words and expressions"},
};

const basic_rows_t stepper_gcode_rows = {COMMANDS(commands)};
