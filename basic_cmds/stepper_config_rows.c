// Rows of the commands that set the machine up. Context: main loop.
#include "basic_cmds/configure.h"
#include "basic_cmds/gcode_lines.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/tables.h"
#include "stepper/stepper.h"
#include "stepper/stepper_outputs.h"

static const basic_arg_spec_t init_args[INIT_ARGS] = {
    // Either order; configure_init() checks the ranges.
    [INIT_TOLERANCE] = {"arc_tolerance", BASIC_ARG_NUMBER, DEFAULTS,
                        .fallback = CONFIGURE_TOLERANCE, .unit = "mm",
                        .help = "greatest radial error of an arc, above 0 to 10; more than that is "
                                "taken as buffer_size"},
    [INIT_BUFFER] = {"buffer_size", BASIC_ARG_NUMBER, DEFAULTS, .fallback = STEPPER_BLOCKS_DEFAULT,
                     .help = "slots of the look-ahead queue, 1 to 1024; less than that is taken as "
                             "arc_tolerance"},
    [INIT_ESTOP] = {"estop_pin", BASIC_ARG_PIN, OPTIONAL,
                    .help = "emergency stop input, active low with pull-up"},
    [INIT_KEEP] = SWITCH_ARG("estop_keep_enabled", "1: drivers stay on in an emergency stop"),
};

#define SCALE_RANGE .min = 0.001, .max = 100000
#define VELOCITY_RANGE .min = 0.001, .max = 10000000
#define ACCELERATION_RANGE .min = 0.01, .max = 1000000
#define BACKOFF_RANGE .min = 0, .max = 1000

static const basic_arg_spec_t axis_args[AXIS_ARGS] = {
    [AXIS_ARG_AXIS] = AXIS_ARG,
    [AXIS_ARG_STEP] = {"step_pin", BASIC_ARG_PIN, .help = "step output, a pulse of 10 us"},
    [AXIS_ARG_DIR] = {"dir_pin", BASIC_ARG_PIN, .help = "direction output, high counts up"},
    [AXIS_ARG_ENABLE] = {"enable_pin", BASIC_ARG_PIN, OPTIONAL,
                         .help = "driver enable, active low"},
    [AXIS_ARG_INVERT] = SWITCH_ARG("dir_invert", "1: direction output low counts up"),
    [AXIS_ARG_SCALE] = {"steps_per_unit", BASIC_ARG_NUMBER, DEFAULTS, SCALE_RANGE, .fallback = 200,
                        .unit = "steps/mm or steps/deg", .help = "scale"},
    [AXIS_ARG_VELOCITY] = {"max_vel", BASIC_ARG_NUMBER, DEFAULTS, VELOCITY_RANGE, .fallback = 6000,
                           .unit = "mm/min or deg/min", .help = "greatest speed"},
    [AXIS_ARG_ACCELERATION] = {"max_accel", BASIC_ARG_NUMBER, DEFAULTS, ACCELERATION_RANGE,
                               .fallback = 500, .unit = "mm/s^2 or deg/s^2",
                               .help = "greatest acceleration"},
    [AXIS_ARG_BACKOFF] = {"home_backoff_mm", BASIC_ARG_NUMBER, DEFAULTS | ABOVE, BACKOFF_RANGE,
                          .fallback = 3, .unit = "mm", .help = "way back from the home switch"},
};

static const basic_arg_spec_t tune_args[TUNE_ARGS] = {
    [TUNE_AXIS] = AXIS_ARG,
    [TUNE_INVERT] = {"dir_invert", BASIC_ARG_INTEGER, OPTIONAL, .min = 0, .max = 1,
                     .help = "1: direction output low counts up"},
    [TUNE_SCALE] = {"steps_per_unit", BASIC_ARG_NUMBER, OPTIONAL, SCALE_RANGE,
                    .unit = "steps/mm or steps/deg",
                    .help = "scale; the position is unknown after a change"},
    [TUNE_VELOCITY] = {"max_vel", BASIC_ARG_NUMBER, OPTIONAL, VELOCITY_RANGE,
                       .unit = "mm/min or deg/min", .help = "greatest speed"},
    [TUNE_ACCELERATION] = {"max_accel", BASIC_ARG_NUMBER, OPTIONAL, ACCELERATION_RANGE,
                           .unit = "mm/s^2 or deg/s^2", .help = "greatest acceleration"},
    [TUNE_BACKOFF] = {"home_backoff_mm", BASIC_ARG_NUMBER, OPTIONAL | ABOVE, BACKOFF_RANGE,
                      .unit = "mm", .help = "way back from the home switch"},
};

static const basic_arg_spec_t invert_args[] = {
    AXIS_ARG,
    {"dir_invert", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: direction output low counts up, 0: high does"},
};

static const basic_arg_spec_t enable_args[] = {
    {"axis", BASIC_ARG_CHOICE, .choices = "X|Y|Z|A|" CONFIGURE_ALL_AXES,
     .help = "the axis, or all that have an enable pin"},
    {"on", BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1, .fallback = 1,
     .help = "1: driver on, 0: off"},
};

static const basic_arg_spec_t arc_args[] = {
    {"tolerance", BASIC_ARG_NUMBER, OPTIONAL | ABOVE, .min = 0, .max = CONFIGURE_TOLERANCE_MAX,
     .unit = "mm", .help = "greatest radial error of an arc; left out: shows it"},
};

static const basic_arg_spec_t limits_args[LIMITS_ARGS] = {
    [LIMITS_AXIS] = LINEAR_AXIS_ARG,
    [LIMITS_MIN] = {"min_mm", BASIC_ARG_NUMBER, .unit = "mm", .help = "lowest machine position"},
    [LIMITS_MAX] = {"max_mm", BASIC_ARG_NUMBER, .unit = "mm", .help = "highest machine position"},
};

static const basic_arg_spec_t spindle_args[SPINDLE_ARGS] = {
    [SPINDLE_PIN] = {"pin", BASIC_ARG_PIN, OPTIONAL,
                     .help = "output switched by M3 and M5, 0: none"},
    [SPINDLE_INVERT] = SWITCH_ARG("invert", "1: low is on"),
    [SPINDLE_MAX] = {"max_rpm", BASIC_ARG_NUMBER, DEFAULTS, .min = 0,
                     .max = STEPPER_SPINDLE_RPM_MAX, .unit = "1/min",
                     .help = "speed at 100 % PWM duty; 0: no PWM, the output is on or off"},
    [SPINDLE_MIN] = {"min_rpm", BASIC_ARG_NUMBER, DEFAULTS, .min = 0,
                     .max = STEPPER_SPINDLE_RPM_MAX, .unit = "1/min",
                     .help = "lower speeds above 0 become this one"},
    [SPINDLE_PWM] = {"pwm_hz", BASIC_ARG_NUMBER, DEFAULTS, .min = 1, .max = 1000000,
                     .fallback = STEPPER_SPINDLE_PWM_HZ_DEFAULT, .unit = "Hz",
                     .help = "frequency of the PWM; the pin's slice serves nothing else then"},
    [SPINDLE_SPINUP] = {"spinup_ms", BASIC_ARG_INTEGER, DEFAULTS, .min = 0,
                        .max = STEPPER_SPINDLE_SPINUP_MS_MAX, .unit = "ms",
                        .help = "motion waits so long when the spindle starts or turns round"},
    [SPINDLE_DIR] = {"dir_pin", BASIC_ARG_PIN, OPTIONAL,
                     .help = "low for M3, high for M4; without it only a laser has M4"},
};

static const basic_arg_spec_t laser_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: S is the power; M3 constant, M4 in proportion to the speed; the beam is off in G0 "
             "and at standstill; 0: a spindle"},
};

static const basic_arg_spec_t coolant_args[COOLANT_ARGS] = {
    [COOLANT_FLOOD] = {"flood_pin", BASIC_ARG_PIN, OPTIONAL,
                       .help = "output switched on by M8 and off by M9, 0: none"},
    [COOLANT_MIST] = {"mist_pin", BASIC_ARG_PIN, OPTIONAL,
                      .help = "output switched on by M7 and off by M9, 0: none"},
    [COOLANT_INVERT] = SWITCH_ARG("invert", "1: low is on"),
};

static const basic_arg_spec_t junction_args[] = {
    {"deviation_mm", BASIC_ARG_NUMBER, .min = 0, .max = 10, .unit = "mm",
     .help = "how far an arc that replaces the corner would pass from it; more is faster"},
};

static const basic_arg_spec_t scurve_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: acceleration changes gradually, 0: at once"},
};

#define AXIS_JERK_ARG(letter, axis_unit)                                                           \
    {letter,                                                                                       \
     BASIC_ARG_NUMBER,                                                                             \
     OPTIONAL,                                                                                     \
     .min = STEPPER_JERK_MIN,                                                                      \
     .max = STEPPER_JERK_MAX,                                                                      \
     .unit = axis_unit,                                                                            \
     .help = "the axis's own limit; left out: none"}

static const basic_arg_spec_t jerk_args[] = {
    {"value", BASIC_ARG_NUMBER, .min = STEPPER_JERK_MIN, .max = STEPPER_JERK_MAX, .unit = "mm/s^3",
     .help = "limit along the path"},
    AXIS_JERK_ARG("x", "mm/s^3"),
    AXIS_JERK_ARG("y", "mm/s^3"),
    AXIS_JERK_ARG("z", "mm/s^3"),
    AXIS_JERK_ARG("a", "deg/s^3"),
};

static const basic_arg_spec_t arc_legacy_args[] = {
    {"on", BASIC_ARG_INTEGER, .min = 0, .max = 1,
     .help = "1: the A word of G2 and G3 is ignored, 0: A turns along with the arc"},
};

static const basic_command_t commands[] = {
    {"STEPPER INIT", ARGS(init_args), configure_init, "Prepares the motion system"},
    {"STEPPER AXIS", ARGS(axis_args), configure_axis, "Configures an axis"},
    {"STEPPER TUNE", ARGS(tune_args), configure_tune,
     "Changes an axis that is configured; what is left out stays as it is"},
    {"STEPPER INVERT", ARGS(invert_args), configure_invert, "Turns the direction of an axis round"},
    {"STEPPER ENABLE", ARGS(enable_args), configure_enable, "Turns drivers on or off by hand"},
    {"STEPPER RESET", .run = configure_reset,
     .help = "Forgets all axes, pins but the E-STOP input, limits and settings"},
    {"STEPPER LIMITS", ARGS(limits_args), configure_limits, "Sets the soft limits of an axis"},
    {"STEPPER SPINDLE", ARGS(spindle_args), configure_spindle, "Sets the spindle output"},
    {"STEPPER LASER", ARGS(laser_args), configure_laser,
     "Says that the spindle output, with PWM, is a laser"},
    {"STEPPER COOLANT", ARGS(coolant_args), configure_coolant, "Sets the coolant outputs"},
    {"STEPPER JUNCTION", ARGS(junction_args), configure_junction, "Sets the junction deviation"},
    {"STEPPER SCURVE", ARGS(scurve_args), configure_scurve,
     "Chooses S-curves or trapezoids for what is queued from now on"},
    {"STEPPER JERK", ARGS(jerk_args), configure_jerk,
     "Sets how fast the acceleration of S-curves may change; for what is queued from now on"},
    {"STEPPER ARC", ARGS(arc_args), configure_arc, "Sets or shows the tolerance of arcs"},
    {"STEPPER ARC LEGACY", ARGS(arc_legacy_args), gcode_lines_arc_legacy,
     "Chooses what A means on an arc"},
};

const basic_rows_t stepper_config_rows = {COMMANDS(commands)};
