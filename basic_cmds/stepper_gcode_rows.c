// Rows of the commands that take G-code. Context: main loop.
#include "basic_cmds/gcode_lines.h"
#include "basic_cmds/job.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"

static const basic_arg_spec_t gc_args[] = {
    {"gcode", BASIC_ARG_RAW, .help = "a line of G-code as it is"},
};

static const basic_arg_spec_t gs_args[] = {
    {"string$", BASIC_ARG_TEXT, .help = "a line of G-code as a string expression"},
};

static const basic_arg_spec_t gcode_args[] = {
    {"code", BASIC_ARG_WORD, OPTIONAL, .help = "G0, M3, ...; blank repeats the last motion"},
    {"letter", BASIC_ARG_WORD, BASIC_ARG_REPEAT, .help = "X, Y, Z, A, F, P ..., also G and M"},
    {"value", BASIC_ARG_NUMBER, .help = "its value"},
};

static const basic_arg_spec_t dialect_args[] = {
    {"dialect", BASIC_ARG_CHOICE, .choices = GCODE_LINES_DIALECTS,
     .help = "REFERENCE: G28 homes, G4 P in ms; NIST: G28 goes to the place of G28.1, G4 P in s"},
};

static const basic_arg_spec_t block_delete_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: lines that begin with / are skipped, 0: carried out"},
};

static const basic_arg_spec_t optional_stop_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: M1 pauses as M0 does, 0: it does nothing"},
};

static const basic_arg_spec_t file_args[] = {
    {"name$", BASIC_ARG_TEXT, .help = "a G-code file of A:"},
};

static const basic_command_t commands[] = {
    {"STEPPER GC", ARGS(gc_args), gcode_lines_text, "Queues a line of G-code"},
    {"STEPPER GS", ARGS(gs_args), gcode_lines_text, "Queues a line of G-code from a string"},
    {"STEPPER GCODE", ARGS(gcode_args), gcode_lines_words,
     "Queues G-code given as words and expressions"},
    {"STEPPER DIALECT", ARGS(dialect_args), gcode_lines_dialect,
     "Chooses what G4 and G28 mean; INIT chooses REFERENCE"},
    {"STEPPER BLOCKDELETE", ARGS(block_delete_args), gcode_lines_block_delete,
     "Says what becomes of G-code lines that begin with /"},
    {"STEPPER OPTIONALSTOP", ARGS(optional_stop_args), gcode_lines_optional_stop,
     "Says whether M1 pauses"},
    {"STEPPER FILE", ARGS(file_args), job_file,
     "Carries a G-code file out in the background; HOLD, RESUME, OVERRIDE and STOP act on it"},
    {"STEPPER CHECK", ARGS(file_args), job_check,
     "Looks through a G-code file without moving: errors, where it leads, how long it takes"},
};

static const basic_function_t functions[] = {
    {"PEEK", "STEPPER LINE", .evaluate = job_line,
     .help = "Line of the G-code file that is being executed, or was last"},
    {"PEEK", "STEPPER PERCENT", .evaluate = job_percent,
     .help = "How much of the G-code file has been executed"},
};

const basic_rows_t stepper_gcode_rows = {COMMANDS(commands), FUNCTIONS(functions)};
