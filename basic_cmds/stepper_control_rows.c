// Rows of the commands that move, stop and place the machine. Context: main loop.
#include "basic_cmds/control.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"
#include "stepper/stepper.h"

static const basic_arg_spec_t run_args[] = {
    {"mode", BASIC_ARG_INTEGER, OPTIONAL, .min = 0, .max = 1, .help = "the same as the next"},
    {"mode", BASIC_ARG_INTEGER, OPTIONAL, .min = 0, .max = 1,
     .help = "when idle 0: drivers stay on, 1: drivers off"},
};

static const basic_arg_spec_t override_args[] = {
    {"what", BASIC_ARG_CHOICE, OPTIONAL, .choices = "FEED|RAPID",
     .help = "G1 feeds, or G0 moves; without any argument it shows both"},
    {"percent", BASIC_ARG_INTEGER, OPTIONAL, .min = STEPPER_OVERRIDE_MIN,
     .max = STEPPER_OVERRIDE_MAX, .unit = "%", .help = "of the programmed speed; RAPID up to 100"},
};

static const basic_arg_spec_t jog_args[JOG_ARGS] = {
    [JOG_AXIS] = AXIS_ARG,
    [JOG_DISTANCE] = {"distance", BASIC_ARG_NUMBER, .min = -1e9, .max = 1e9, .unit = "mm or deg",
                      .choices = JOG_CHOICES,
                      .help =
                          "from where it stands; + and - go on until STEPPER JOG STOP or a limit"},
    [JOG_FEED] = {"feed", BASIC_ARG_NUMBER, OPTIONAL, .min = 0.001, .max = 1e9,
                  .unit = "mm/min or deg/min", .help = "left out: as fast as the axis may"},
};

static const basic_arg_spec_t position_args[] = {
    AXIS_ARG,
    {"position", BASIC_ARG_NUMBER, .unit = "mm or deg", .help = "machine position where it stands"},
};

static const basic_arg_spec_t option_error_args[] = {
    {"what", BASIC_ARG_CHOICE, .choices = CONTROL_ERROR_CHOICES,
     .help = "motion comes to a controlled stop, or runs out"},
};

static const basic_command_t commands[] = {
    {"STEPPER RUN", ARGS(run_args), control_run, "Turns drivers on and executes what is queued"},
    {"STEPPER CLEAR", .run = control_clear, .help = "Empties the queue while nothing moves"},
    {"STEPPER STOP", .run = control_stop,
     .help = "Brakes to a standstill and empties the queue; the position stays exact"},
    {"STEPPER HOLD", .run = control_hold,
     .help = "Feed hold, as Ctrl-F: brakes to a standstill and keeps the queue"},
    {"STEPPER RESUME", .run = control_resume, .help = "Goes on after a feed hold, as Ctrl-R"},
    {"STEPPER OVERRIDE", ARGS(override_args), control_override,
     "Makes all feeds or all rapid moves slower or faster, at once"},
    {"STEPPER JOG STOP", .run = control_jog_stop, .help = "Brakes a jog to a standstill"},
    {"STEPPER JOG", ARGS(jog_args), control_jog,
     "Moves an axis by hand; a further JOG on the way changes the target without a stop"},
    {"STEPPER ESTOP", .run = control_estop, .help = "Stops at once, drivers and spindle off"},
    {"STEPPER CLOSE", .run = control_close, .help = "Stops motion and gives all pins back"},
    {"STEPPER POSITION HOME", .run = control_position_home,
     .help = "Makes this place zero of all axes and clears G92"},
    {"STEPPER POSITION", ARGS(position_args), control_position,
     "Says at which machine position an axis stands"},
    {"OPTION ERROR", ARGS(option_error_args), control_option_error,
     "Says what becomes of motion when an error ends a program; kept over power-off"},
};

const basic_rows_t stepper_control_rows = {COMMANDS(commands)};
