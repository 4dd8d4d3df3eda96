// Handlers of I2C and I2C2: a program as the master of a bus. Inside basic_cmds/ only. Context:
// main loop.
#ifndef BASIC_CMDS_I2C_H
#define BASIC_CMDS_I2C_H

#include "basic/basic.h"

extern const basic_arg_spec_t i2c_setpin_args[3];
extern const basic_arg_spec_t i2c_open_args[2];
extern const basic_arg_spec_t i2c_write_args[4];
extern const basic_arg_spec_t i2c_read_args[4];
extern const basic_arg_spec_t i2c_check_args[1];

err_t i2c_setpin(const basic_arg_t *args, size_t count);
err_t i2c_open(const basic_arg_t *args, size_t count);
err_t i2c_write(const basic_arg_t *args, size_t count);
err_t i2c_read(const basic_arg_t *args, size_t count);
err_t i2c_check(const basic_arg_t *args, size_t count);
err_t i2c_close(const basic_arg_t *args, size_t count);
// The same for I2C2.
err_t i2c_open_2(const basic_arg_t *args, size_t count);
err_t i2c_write_2(const basic_arg_t *args, size_t count);
err_t i2c_read_2(const basic_arg_t *args, size_t count);
err_t i2c_check_2(const basic_arg_t *args, size_t count);
err_t i2c_close_2(const basic_arg_t *args, size_t count);

// MM.I2C
err_t i2c_result(const basic_arg_t *args, size_t count, basic_value_t *result);

// A new program knows nothing of earlier transfers.
void i2c_clear(void);

#endif
