// Rows of I2C and SPI. Context: main loop.
#include "basic_cmds/i2c.h"
#include "basic_cmds/row_args.h"
#include "basic_cmds/spi.h"
#include "basic_cmds/tables.h"

static const basic_command_t commands[] = {
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
};

static const basic_function_t functions[] = {
    {"MM.I2C", NULL, .evaluate = i2c_result,
     .help = "What came of the last I2C transfer: 0 all well, 1 no acknowledge, 2 timeout"},
    {"SPI", NULL, ARGS(spi_exchange_args), spi_exchange,
     "Sends a word and gives the one that came meanwhile"},
    {"SPI2", NULL, ARGS(spi_exchange_args), spi_exchange_2, "The same on SPI2"},
};

const basic_rows_t bus_rows = {COMMANDS(commands), FUNCTIONS(functions)};
