// Short forms for the rows of this folder. Inside basic_cmds/ only.
#ifndef BASIC_CMDS_ROW_ARGS_H
#define BASIC_CMDS_ROW_ARGS_H

#include "basic/basic.h"

#define OPTIONAL BASIC_ARG_OPTIONAL
#define DEFAULTS (BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT)
#define ABOVE BASIC_ARG_ABOVE_MIN

#define AXIS_ARG {"axis", BASIC_ARG_CHOICE, .choices = "X|Y|Z|A", .help = "the axis"}
#define LINEAR_AXIS_ARG {"axis", BASIC_ARG_CHOICE, .choices = "X|Y|Z", .help = "the axis"}
#define SWITCH_ARG(arg_name, text)                                                                 \
    {arg_name, BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1, .help = text}

// Arguments of a command, functions and so on of a table.
#define ARGS(spec) .args = (spec), .arg_count = COUNT_OF_ARRAY(spec)
#define COMMANDS(list) .commands = (list), .command_count = COUNT_OF_ARRAY(list)
#define FUNCTIONS(list) .functions = (list), .function_count = COUNT_OF_ARRAY(list)
#define ASSIGNMENTS(list) .assignments = (list), .assignment_count = COUNT_OF_ARRAY(list)

#endif
