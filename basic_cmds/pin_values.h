// Handlers of PIN, PORT, PULSE, PWM and SERVO, and the arguments of their rows. Inside basic_cmds/
// only. Context: main loop.
#ifndef BASIC_CMDS_PIN_VALUES_H
#define BASIC_CMDS_PIN_VALUES_H

#include "basic/basic.h"

extern const basic_arg_spec_t pin_values_read_args[1];
extern const basic_arg_spec_t pin_values_write_args[2];
extern const basic_arg_spec_t pin_values_read_port_args[4];
extern const basic_arg_spec_t pin_values_write_port_args[5];
extern const basic_arg_spec_t pin_values_pulse_args[2];
extern const basic_arg_spec_t pin_values_pwm_args[6];
extern const basic_arg_spec_t pin_values_pwm_off_args[2];
extern const basic_arg_spec_t pin_values_sync_args[8];
extern const basic_arg_spec_t pin_values_servo_args[3];

err_t pin_values_read(const basic_arg_t *args, size_t count, basic_value_t *result);
err_t pin_values_temperature(const basic_arg_t *args, size_t count, basic_value_t *result);
err_t pin_values_read_port(const basic_arg_t *args, size_t count, basic_value_t *result);

err_t pin_values_write(const basic_arg_t *args, size_t count);
err_t pin_values_write_port(const basic_arg_t *args, size_t count);
err_t pin_values_pulse(const basic_arg_t *args, size_t count);
err_t pin_values_pwm(const basic_arg_t *args, size_t count);
err_t pin_values_pwm_off(const basic_arg_t *args, size_t count);
err_t pin_values_sync(const basic_arg_t *args, size_t count);
err_t pin_values_servo(const basic_arg_t *args, size_t count);

#endif
