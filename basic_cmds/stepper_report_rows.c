// Rows of what tells about the machine. Context: main loop.
#include "basic_cmds/report.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"

static const basic_arg_spec_t peek_args[] = {
    {"what", BASIC_ARG_CHOICE, .choices = PEEK_CHOICES,
     .help = "work position of an axis, ACTIVE (-1, 0, 1), STATUS bits, free BUFFER slots "
             "or SPEED along the path in mm/min"},
};

static const basic_command_t commands[] = {
    {"STEPPER STATUS", .run = report_status, .help = "Shows state, positions and configuration"},
};

static const basic_function_t functions[] = {
    {"PEEK", "STEPPER", ARGS(peek_args), report_peek, "State of the motion system"},
};

const basic_rows_t stepper_report_rows = {COMMANDS(commands), FUNCTIONS(functions)};
