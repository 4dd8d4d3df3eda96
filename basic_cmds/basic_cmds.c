// The rows: every command and function of the product with its arguments, ranges and help. Parsing,
// range checks, error texts, HELP and the reference page all come from here. Context: main loop.
#include "basic_cmds/basic_cmds.h"

#include "basic_cmds/com.h"
#include "basic_cmds/configure.h"
#include "basic_cmds/control.h"
#include "basic_cmds/i2c.h"
#include "basic_cmds/pin_values.h"
#include "basic_cmds/report.h"
#include "basic_cmds/setpin.h"
#include "basic_cmds/spi.h"
#include "stepper/stepper.h"

#define CTRL_F 6
#define CTRL_R 18

#define OPTIONAL BASIC_ARG_OPTIONAL
#define DEFAULTS (BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT)
#define ABOVE BASIC_ARG_ABOVE_MIN

#define AXIS_ARG {"axis", BASIC_ARG_CHOICE, .choices = "X|Y|Z|A", .help = "the axis"}
#define LINEAR_AXIS_ARG {"axis", BASIC_ARG_CHOICE, .choices = "X|Y|Z", .help = "the axis"}
#define SWITCH_ARG(arg_name, text)                                                                 \
    {arg_name, BASIC_ARG_INTEGER, DEFAULTS, .min = 0, .max = 1, .help = text}

static const basic_arg_spec_t init_args[INIT_ARGS] = {
    [INIT_TOLERANCE] = {"arc_tolerance", BASIC_ARG_NUMBER, DEFAULTS | ABOVE, .min = 0, .max = 10,
                        .fallback = 0.05, .unit = "mm", .help = "greatest radial error of an arc"},
    [INIT_BUFFER] = {"buffer_size", BASIC_ARG_INTEGER, DEFAULTS, .min = 1,
                     .max = STEPPER_BLOCKS_MAX, .fallback = STEPPER_BLOCKS_DEFAULT,
                     .help = "slots of the look-ahead queue"},
    [INIT_ESTOP] = {"estop_pin", BASIC_ARG_PIN, OPTIONAL,
                    .help = "emergency stop input, active low with pull-up"},
    [INIT_KEEP] = SWITCH_ARG("estop_keep_enabled", "1: drivers stay on in an emergency stop"),
};

static const basic_arg_spec_t axis_args[AXIS_ARGS] = {
    [AXIS_ARG_AXIS] = AXIS_ARG,
    [AXIS_ARG_STEP] = {"step_pin", BASIC_ARG_PIN, .help = "step output, a pulse of 10 us"},
    [AXIS_ARG_DIR] = {"dir_pin", BASIC_ARG_PIN, .help = "direction output, high counts up"},
    [AXIS_ARG_ENABLE] = {"enable_pin", BASIC_ARG_PIN, OPTIONAL,
                         .help = "driver enable, active low"},
    [AXIS_ARG_INVERT] = SWITCH_ARG("dir_invert", "1: direction output low counts up"),
    [AXIS_ARG_SCALE] = {"steps_per_unit", BASIC_ARG_NUMBER, DEFAULTS, .min = 0.001, .max = 100000,
                        .fallback = 200, .unit = "steps/mm or steps/deg", .help = "scale"},
    [AXIS_ARG_VELOCITY] = {"max_vel", BASIC_ARG_NUMBER, DEFAULTS, .min = 0.001, .max = 10000000,
                           .fallback = 6000, .unit = "mm/min or deg/min", .help = "greatest speed"},
    [AXIS_ARG_ACCELERATION] = {"max_accel", BASIC_ARG_NUMBER, DEFAULTS, .min = 0.01, .max = 1000000,
                               .fallback = 500, .unit = "mm/s^2 or deg/s^2",
                               .help = "greatest acceleration"},
    [AXIS_ARG_BACKOFF] = {"home_backoff_mm", BASIC_ARG_NUMBER, DEFAULTS | ABOVE, .min = 0,
                          .max = 1000, .fallback = 3, .unit = "mm",
                          .help = "way back from the home switch"},
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

static const basic_arg_spec_t peek_args[] = {
    {"what", BASIC_ARG_CHOICE, .choices = PEEK_CHOICES,
     .help = "work position of an axis, ACTIVE (-1, 0, 1), STATUS bits, free BUFFER slots "
             "or SPEED along the path in mm/min"},
};

static const basic_arg_spec_t option_error_args[] = {
    {"what", BASIC_ARG_CHOICE, .choices = CONTROL_ERROR_CHOICES,
     .help = "motion comes to a controlled stop, or runs out"},
};

#define ARGS(spec) .args = (spec), .arg_count = COUNT_OF_ARRAY(spec)

const basic_command_t basic_cmds_commands[] = {
    {"STEPPER INIT", ARGS(init_args), configure_init, "Prepares the motion system"},
    {"STEPPER AXIS", ARGS(axis_args), configure_axis, "Configures an axis"},
    {"STEPPER LIMITS", ARGS(limits_args), configure_limits, "Sets the soft limits of an axis"},
    {"STEPPER SPINDLE", ARGS(spindle_args), configure_spindle, "Sets the spindle output"},
    {"STEPPER JUNCTION", ARGS(junction_args), configure_junction, "Sets the junction deviation"},
    {"STEPPER SCURVE", ARGS(scurve_args), configure_scurve,
     "Chooses S-curves or trapezoids for what is queued from now on"},
    {"STEPPER JERK", ARGS(jerk_args), configure_jerk,
     "Sets how fast the acceleration of S-curves may change; for what is queued from now on"},
    {"STEPPER ARC LEGACY", ARGS(arc_legacy_args), configure_arc_legacy,
     "Chooses what A means on an arc"},
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
    {"STEPPER GC", ARGS(gc_args), control_gcode_text, "Queues a line of G-code"},
    {"STEPPER GS", ARGS(gs_args), control_gcode_text, "Queues a line of G-code from a string"},
    {"STEPPER GCODE", ARGS(gcode_args), control_gcode_words,
     "Queues G-code given as words and expressions"},
    {"STEPPER STATUS", .run = report_status, .help = "Shows state, positions and configuration"},
    {"SETPIN", ARGS(setpin_off_args), setpin_off, "Gives a pin back"},
    {"SETPIN", ARGS(setpin_input_args), setpin_input, "Makes a pin a digital input"},
    {"SETPIN", ARGS(setpin_output_args), setpin_output, "Makes a pin a digital output"},
    {"SETPIN", ARGS(setpin_analog_args), setpin_analog, "Makes a pin an analog input"},
    {"SETPIN", ARGS(setpin_frequency_args), setpin_frequency, "Measures the frequency at a pin"},
    {"SETPIN", ARGS(setpin_period_args), setpin_period, "Measures the period at a pin"},
    {"SETPIN", ARGS(setpin_counter_args), setpin_counter, "Counts at a pin"},
    {"SETPIN", ARGS(setpin_interrupt_args), setpin_interrupt, "Calls a SUB when a pin changes"},
    {"SETPIN", ARGS(setpin_pwm_args), setpin_pwm, "Gives a pin to its PWM slice"},
    {"SETPIN", ARGS(com_setpin_args), com_setpin,
     "Gives a serial port its pins, for OPEN \"COM1:9600\" AS #1"},
    {"SETPIN", ARGS(i2c_setpin_args), i2c_setpin, "Gives an I2C bus its pins"},
    {"SETPIN", ARGS(spi_setpin_args), spi_setpin, "Gives an SPI bus its pins"},
    {"I2C OPEN", ARGS(i2c_open_args), i2c_open, "Makes the program the master of a bus"},
    {"I2C WRITE", ARGS(i2c_write_args), i2c_write, "Sends bytes; MM.I2C tells what came of it"},
    {"I2C READ", ARGS(i2c_read_args), i2c_read,
     "Receives bytes; if that fails, which MM.I2C tells, the variable stays as it is"},
    {"I2C CHECK", ARGS(i2c_check_args), i2c_check,
     "Reads a byte of a device: MM.I2C is 0 if there is one"},
    {"I2C CLOSE", .run = i2c_close, .help = "Ends it; the pins stay the bus's"},
    {"I2C2 OPEN", ARGS(i2c_open_args), i2c_open_2, "Makes the program the master of a bus"},
    {"I2C2 WRITE", ARGS(i2c_write_args), i2c_write_2, "Sends bytes; MM.I2C tells what came of it"},
    {"I2C2 READ", ARGS(i2c_read_args), i2c_read_2,
     "Receives bytes; if that fails, which MM.I2C tells, the variable stays as it is"},
    {"I2C2 CHECK", ARGS(i2c_check_args), i2c_check_2,
     "Reads a byte of a device: MM.I2C is 0 if there is one"},
    {"I2C2 CLOSE", .run = i2c_close_2, .help = "Ends it; the pins stay the bus's"},
    {"SPI OPEN", ARGS(spi_open_args), spi_open, "Makes the program the master of a bus"},
    {"SPI WRITE", ARGS(spi_write_args), spi_write, "Sends words; what comes back is dropped"},
    {"SPI READ", ARGS(spi_read_args), spi_read, "Receives words"},
    {"SPI CLOSE", .run = spi_close, .help = "Ends it; the pins stay the bus's"},
    {"SPI2 OPEN", ARGS(spi_open_args), spi_open_2, "Makes the program the master of a bus"},
    {"SPI2 WRITE", ARGS(spi_write_args), spi_write_2, "Sends words; what comes back is dropped"},
    {"SPI2 READ", ARGS(spi_read_args), spi_read_2, "Receives words"},
    {"SPI2 CLOSE", .run = spi_close_2, .help = "Ends it; the pins stay the bus's"},
    {"OPTION PIN NUMBERS", ARGS(setpin_numbers_args), setpin_numbers,
     "Says what a bare number means where a pin is wanted; kept over power-off"},
    {"OPTION VCC", ARGS(setpin_vcc_args), setpin_vcc, "Sets the reference of analog inputs"},
    {"PULSE", ARGS(pin_values_pulse_args), pin_values_pulse, "Inverts an output for a time"},
    {"PWM", ARGS(pin_values_pwm_args), pin_values_pwm,
     "Makes a rectangular wave; what is left out stays as it is"},
    {"PWM", ARGS(pin_values_pwm_off_args), pin_values_pwm_off, "Ends it"},
    {"PWM SYNC", ARGS(pin_values_sync_args), pin_values_sync, "Starts several slices together"},
    {"SERVO", ARGS(pin_values_servo_args), pin_values_servo, "Makes the pulses for model servos"},
    {"SERVO", ARGS(pin_values_pwm_off_args), pin_values_pwm_off, "Ends them"},
    {"OPTION ERROR", ARGS(option_error_args), control_option_error,
     "Says what becomes of motion when an error ends a program; kept over power-off"},
};
const size_t basic_cmds_command_count = COUNT_OF_ARRAY(basic_cmds_commands);

const basic_function_t basic_cmds_functions[] = {
    {"PEEK", "STEPPER", ARGS(peek_args), report_peek, "State of the motion system"},
    {"PIN", NULL, ARGS(pin_values_read_args), pin_values_read,
     "Value of a pin as its SETPIN says; the level, if another command has the pin"},
    {"PIN", "TEMP", .evaluate = pin_values_temperature,
     .help = "Temperature of the chip in degrees Celsius"},
    {"MM.I2C", NULL, .evaluate = i2c_result,
     .help = "What came of the last I2C transfer: 0 all well, 1 no acknowledge, 2 timeout"},
    {"SPI", NULL, ARGS(spi_exchange_args), spi_exchange,
     "Sends a word and gives the one that came meanwhile"},
    {"SPI2", NULL, ARGS(spi_exchange_args), spi_exchange_2, "The same on SPI2"},
    {"PORT", NULL, ARGS(pin_values_read_port_args), pin_values_read_port,
     "Levels of several pins at one time as the bits of a number"},
};
const size_t basic_cmds_function_count = COUNT_OF_ARRAY(basic_cmds_functions);

const basic_assignment_t basic_cmds_assignments[] = {
    {"PIN", ARGS(pin_values_write_args), pin_values_write, "Sets an output"},
    {"PORT", ARGS(pin_values_write_port_args), pin_values_write_port,
     "Sets several outputs at one time"},
};
const size_t basic_cmds_assignment_count = COUNT_OF_ARRAY(basic_cmds_assignments);

const basic_device_t *const basic_cmds_devices[] = {&com_device};
const size_t basic_cmds_device_count = COUNT_OF_ARRAY(basic_cmds_devices);

void basic_cmds_clear(void) {
    com_clear();
    i2c_clear();
    setpin_clear();
}

void basic_cmds_background(void) {
    setpin_background();
    com_background();
    if (stepper_next_event() == STEPPER_EVENT_ESTOP) {
        basic_notice("Hardware E-STOP trip - emergency stop, position unknown");
    }
}

void basic_cmds_break(void) {
    if (stepper_active() > 0) {
        basic_notice("Ctrl-C: motion stops, what was queued is dropped");
    }
    stepper_stop();
}

void basic_cmds_error(void) {
    control_error();
}

err_t basic_cmds_may_restart(void) {
    stepper_status_t status;
    stepper_status(&status);
    bool active = status.moving || stepper_active() > 0;
    return active ? err_raise(ERR_STEPPER_BUSY, "%s", "") : ERR_OK;
}

bool basic_cmds_control(char c) {
    stepper_status_t status;
    stepper_status(&status);
    if ((c != CTRL_F && c != CTRL_R) || (!status.moving && !status.holding)) {
        return false;
    }
    bool hold = c == CTRL_F;
    if (hold != status.holding && !status.stopping && stepper_hold(hold) == ERR_OK) {
        basic_notice(hold ? "Feed hold (Ctrl-R or STEPPER RESUME goes on)" : "Resumed");
    }
    return true;
}
