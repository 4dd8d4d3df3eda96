// Rows of a program's pins. SETPIN is here as a whole, since rows of one name stand together.
// Context: main loop.
#include "basic_cmds/com.h"
#include "basic_cmds/i2c.h"
#include "basic_cmds/pin_values.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/setpin.h"
#include "basic_cmds/spi.h"
#include "basic_cmds/tables.h"

static const basic_command_t commands[] = {
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
};

static const basic_function_t functions[] = {
    {"PIN", NULL, ARGS(pin_values_read_args), pin_values_read,
     "Value of a pin as its SETPIN says; the level, if another command has the pin"},
    {"PIN", "TEMP", .evaluate = pin_values_temperature,
     .help = "Temperature of the chip in degrees Celsius"},
    {"PORT", NULL, ARGS(pin_values_read_port_args), pin_values_read_port,
     "Levels of several pins at one time as the bits of a number"},
};

static const basic_assignment_t assignments[] = {
    {"PIN", ARGS(pin_values_write_args), pin_values_write, "Sets an output"},
    {"PORT", ARGS(pin_values_write_port_args), pin_values_write_port,
     "Sets several outputs at one time"},
};

const basic_rows_t pin_rows = {COMMANDS(commands), FUNCTIONS(functions), ASSIGNMENTS(assignments)};
