// Rows of homing and probing. Context: main loop.
#include "basic_cmds/homing.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"

static const basic_arg_spec_t home_args[HOME_ARGS] = {
    [HOME_AXIS] = LINEAR_AXIS_ARG,
    [HOME_END] = {"end", BASIC_ARG_CHOICE, OPTIONAL, .choices = HOME_END_CHOICES,
                  .help = "where its switch is; left out: MIN, unless only MAX has one"},
    [HOME_SEEK] = {"seek", BASIC_ARG_NUMBER, OPTIONAL | ABOVE, .min = 0, .max = 1000000,
                   .unit = "mm/min",
                   .help = "feed of the fast approach; left out: half of max_vel, 3000 at most"},
    [HOME_LATCH] = {"latch", BASIC_ARG_NUMBER, OPTIONAL, .min = 0, .max = 1000000, .unit = "mm/min",
                    .help = "feed of the slow approach, 0: none; left out: a tenth of seek"},
    [HOME_PULL_OFF] = {"pull_off", BASIC_ARG_NUMBER, OPTIONAL | ABOVE, .min = 0, .max = 1000,
                       .unit = "mm",
                       .help = "from the switch to where homing ends; left out: home_backoff_mm"},
    [HOME_TRAVEL] = {"max_travel", BASIC_ARG_NUMBER, OPTIONAL | ABOVE, .min = 0, .max = 100000,
                     .unit = "mm",
                     .help = "how far it looks for the switch; left out: 1.5 times what the soft "
                             "limits span, 1000 without any"},
    [HOME_POSITION] = {"home_position", BASIC_ARG_NUMBER, OPTIONAL, .min = -100000, .max = 100000,
                       .unit = "mm", .help = "machine position where homing ends; left out: 0"},
};

static const basic_arg_spec_t order_args[] = {
    {"group", BASIC_ARG_WORD, .help = "axes that are homed together, as Z or XY"},
    {"group", BASIC_ARG_WORD, BASIC_ARG_REPEAT, .help = "those that follow"},
};

static const basic_arg_spec_t run_args[] = {
    {"axes", BASIC_ARG_WORD, OPTIONAL,
     .help = "which, as XY; left out: all that have a home switch"},
};

static const basic_arg_spec_t probe_args[] = {
    {"pin", BASIC_ARG_PIN, OPTIONAL, .help = "input that is low on contact, 0: none"},
    SWITCH_ARG("invert", "1: high on contact"),
};

static const basic_arg_spec_t peek_args[] = {
    {"what", BASIC_ARG_CHOICE, .choices = PROBE_CHOICES,
     .help = "work position of an axis where the probe changed; OK: 1 if it did; CONTACT: 1 if it "
             "has contact now"},
};

static const basic_command_t commands[] = {
    {"STEPPER HOME", ARGS(home_args), homing_configure,
     "Says how an axis is homed; what is left out has its default"},
    {"STEPPER HOME ORDER", ARGS(order_args), homing_order,
     "Says which axes are homed one after another, and which together"},
    {"STEPPER HOME RUN", ARGS(run_args), homing_run,
     "Homes as G28 does, but goes on with the program meanwhile"},
    {"STEPPER PROBE", ARGS(probe_args), homing_probe_pin, "Sets the probe's input, for G38"},
};

static const basic_function_t functions[] = {
    {"PEEK", "STEPPER PROBE", ARGS(peek_args), homing_peek_probe,
     "What the last probing has found"},
};

const basic_rows_t stepper_homing_rows = {COMMANDS(commands), FUNCTIONS(functions)};
