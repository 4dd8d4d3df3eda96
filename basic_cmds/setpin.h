// Handlers of SETPIN, one for each kind of use, and the arguments of its rows. Inside basic_cmds/
// only. Context: main loop.
#ifndef BASIC_CMDS_SETPIN_H
#define BASIC_CMDS_SETPIN_H

#include "basic/basic.h"

extern const basic_arg_spec_t setpin_off_args[2];
extern const basic_arg_spec_t setpin_input_args[3];
extern const basic_arg_spec_t setpin_output_args[2];
extern const basic_arg_spec_t setpin_analog_args[2];
extern const basic_arg_spec_t setpin_frequency_args[3];
extern const basic_arg_spec_t setpin_period_args[3];
extern const basic_arg_spec_t setpin_counter_args[3];
extern const basic_arg_spec_t setpin_interrupt_args[4];
extern const basic_arg_spec_t setpin_pwm_args[2];

extern const basic_arg_spec_t setpin_numbers_args[1];
extern const basic_arg_spec_t setpin_vcc_args[1];

err_t setpin_off(const basic_arg_t *args, size_t count);
err_t setpin_input(const basic_arg_t *args, size_t count);
err_t setpin_output(const basic_arg_t *args, size_t count);
err_t setpin_analog(const basic_arg_t *args, size_t count);
err_t setpin_frequency(const basic_arg_t *args, size_t count);
err_t setpin_period(const basic_arg_t *args, size_t count);
err_t setpin_counter(const basic_arg_t *args, size_t count);
err_t setpin_interrupt(const basic_arg_t *args, size_t count);
err_t setpin_pwm(const basic_arg_t *args, size_t count);

// OPTION PIN NUMBERS and OPTION VCC.
err_t setpin_numbers(const basic_arg_t *args, size_t count);
err_t setpin_vcc(const basic_arg_t *args, size_t count);

// The pin has another use now.
void setpin_forget_interrupt(unsigned gpio);

// For the background hook: raises the events of pins that changed.
void setpin_background(void);

// All pins of the program back, for the hook of RUN and NEW.
void setpin_clear(void);

#endif
