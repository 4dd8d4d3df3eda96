// Handlers of SPI and SPI2: a program as the master of a bus. Inside basic_cmds/ only. Context:
// main loop.
#ifndef BASIC_CMDS_SPI_H
#define BASIC_CMDS_SPI_H

#include "basic/basic.h"

extern const basic_arg_spec_t spi_setpin_args[4];
extern const basic_arg_spec_t spi_open_args[3];
extern const basic_arg_spec_t spi_write_args[2];
extern const basic_arg_spec_t spi_read_args[2];
extern const basic_arg_spec_t spi_exchange_args[1];

err_t spi_setpin(const basic_arg_t *args, size_t count);
err_t spi_open(const basic_arg_t *args, size_t count);
err_t spi_write(const basic_arg_t *args, size_t count);
err_t spi_read(const basic_arg_t *args, size_t count);
err_t spi_close(const basic_arg_t *args, size_t count);

// SPI(data)
err_t spi_exchange(const basic_arg_t *args, size_t count, basic_value_t *result);

// The same for SPI2.
err_t spi_open_2(const basic_arg_t *args, size_t count);
err_t spi_write_2(const basic_arg_t *args, size_t count);
err_t spi_read_2(const basic_arg_t *args, size_t count);
err_t spi_close_2(const basic_arg_t *args, size_t count);
err_t spi_exchange_2(const basic_arg_t *args, size_t count, basic_value_t *result);

#endif
