// Rows of what tells about the machine. Context: main loop.
#include "basic_cmds/machine_outputs.h"
#include "basic_cmds/report.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"

static const basic_arg_spec_t peek_args[] = {
    {"what", BASIC_ARG_CHOICE, .choices = PEEK_CHOICES,
     .help = "work position of an axis, ACTIVE (-1, 0, 1), STATUS bits, free BUFFER slots "
             "or SPEED along the path in mm/min"},
};

static const basic_command_t commands[] = {
    {"STEPPER BUFFER", .run = report_buffer, .help = "Shows what the queue and the motors do"},
    {"STEPPER STATUS", .run = report_status, .help = "Shows state, positions and configuration"},
};

static const basic_function_t functions[] = {
    {"MM.CODE", NULL, .evaluate = report_free_slots,
     .help = "Free slots of the G-code queue; 0 before STEPPER INIT"},
    {"PEEK", "STEPPER SPINDLE", .evaluate = machine_outputs_peek_spindle,
     .help = "Its speed in 1/min, without PWM 1 for on; negative for M4, 0: off"},
    {"PEEK", "STEPPER COOLANT", .evaluate = machine_outputs_peek_coolant,
     .help = "What is on: 1 mist, 2 flood, 3 both"},
    {"PEEK", "STEPPER", ARGS(peek_args), report_peek, "State of the motion system"},
};

const basic_rows_t stepper_report_rows = {COMMANDS(commands), FUNCTIONS(functions)};
