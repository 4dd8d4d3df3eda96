// Rows of limit switches, recovery and events. Context: main loop.
#include "basic_cmds/row_args.h"
#include "basic_cmds/safety.h"
#include "basic_cmds/tables.h"
#include "stepper/stepper_safety.h"

#define SWITCH_PIN(arg_name, text) {arg_name, BASIC_ARG_PIN, OPTIONAL, .help = text}

static const basic_arg_spec_t hwlimits_args[HWLIMITS_ARGS] = {
    SWITCH_PIN("x_min", "input of the switch at the lower end of X; 0 or blank: none"),
    SWITCH_PIN("y_min", "the same for Y"),
    SWITCH_PIN("z_min", "the same for Z"),
    SWITCH_PIN("x_max", "upper end of X; may be the pin of the lower end"),
    SWITCH_PIN("y_max", "the same for Y"),
    SWITCH_PIN("z_max", "the same for Z"),
    [HWLIMITS_INVERT] = {"invert_mask", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 63,
                         .help = "sum of the active-high switches, which get a pull-down: 1 x_min, "
                                 "2 y_min, 4 z_min, 8 x_max, 16 y_max, 32 z_max"},
};

static const basic_arg_spec_t filter_args[] = {
    {"limit_samples", BASIC_ARG_INTEGER, .min = 1, .max = STEPPER_FILTER_MAX, .unit = "x 10 us",
     .help = "how long a limit switch has to be active to stop the machine; INIT sets 3"},
    {"estop_samples", BASIC_ARG_INTEGER, DEFAULTS, .min = 1, .max = STEPPER_FILTER_MAX,
     .fallback = STEPPER_FILTER_ESTOP, .unit = "x 10 us", .help = "the same for the E-STOP input"},
};

static const basic_arg_spec_t keep_args[] = {
    {"keep", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: drivers stay on when a limit switch stops the machine; INIT sets 0"},
};

static const basic_arg_spec_t on_event_args[] = {
    {"sub", BASIC_ARG_ROUTINE, OPTIONAL, .help = "the SUB, which has no parameters; 0: none"},
};

static const basic_command_t commands[] = {
    {"STEPPER HWLIMITS", ARGS(hwlimits_args), safety_hwlimits,
     "Sets the limit switches, active low with pull-up"},
    {"STEPPER HWLIMITS FILTER", ARGS(filter_args), safety_filter,
     "Sets how long an input has to be active, against noise"},
    {"STEPPER HWLIMITS KEEP", ARGS(keep_args), safety_keep,
     "Chooses whether drivers stay on behind a limit switch, so that no axis drops"},
    {"STEPPER RECOVER", .run = safety_recover,
     .help = "Acknowledges an alarm: motion stopped, queue empty, disarmed, spindle off; drivers "
             "and position stay as they are"},
    {"ON STEPPER EVENT", ARGS(on_event_args), safety_on_event,
     "Calls a SUB when something has happened in the machine; PEEK(STEPPER EVENT) tells what"},
};

static const basic_function_t functions[] = {
    {"PEEK", "STEPPER EVENT", .evaluate = safety_peek_event,
     .help = "Takes the oldest event: 0 none, 1 E-STOP, 2 limit switch, 3 idle, 4 homed, 5 homing "
             "failed, 6 probed, 7 job done, 8 paused"},
};

const basic_rows_t stepper_safety_rows = {COMMANDS(commands), FUNCTIONS(functions)};
