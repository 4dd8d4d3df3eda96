// I2C and I2C2: SETPIN, OPEN, WRITE, READ, CHECK, CLOSE and MM.I2C. Context: main loop.
#include "basic_cmds/i2c.h"

#include "basic_cmds/setpin.h"
#include "io/io.h"
#include "io/io_bus.h"

#define BYTES_MAX 255 // of a transfer, as in MMBasic
#define POLL_US 20u   // in this time the controller's buffers never run out
#define SEVEN_BITS_MAX 127
#define TEN_BITS_MAX 1023

enum { OPTION_KEEP = 1, OPTION_TEN_BITS = 2 };

#define ADDRESS_ARG(most)                                                                          \
    {"addr", BASIC_ARG_INTEGER, .min = 0, .max = most, .help = "address of the device"}
#define OPTION_ARG                                                                                 \
    {"option", BASIC_ARG_INTEGER, .min = 0, .max = 3,                                              \
     .help = "1: keep the bus, the next transfer has a repeated start; 2: the address has ten "    \
             "bits; 3: both"}

const basic_arg_spec_t i2c_setpin_args[] = {
    {"sda", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "data: GP0, GP4, GP8, GP12, GP16, GP20, GP28 for I2C, GP2, GP6, GP10, GP14, GP18, "
             "GP22, GP26 for I2C2"},
    {"scl", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "clock: GP1, GP5, GP9, GP13, GP17, GP21 for I2C, GP3, GP7, GP11, GP15, GP19, GP27 for "
             "I2C2"},
    {"bus", BASIC_ARG_CHOICE, BASIC_ARG_SELECTS, .choices = "I2C|I2C2", .help = "the bus"},
};
const basic_arg_spec_t i2c_open_args[] = {
    {"speed", BASIC_ARG_INTEGER, .min = HAL_I2C_KHZ_MIN, .max = HAL_I2C_KHZ_MAX, .unit = "kHz",
     .help = "100 and 400 are usual"},
    {"timeout", BASIC_ARG_INTEGER, .min = 0, .max = 100000, .unit = "ms",
     .help = "when a transfer is given up; 0: never, but Ctrl-C ends it"},
};
const basic_arg_spec_t i2c_write_args[] = {
    ADDRESS_ARG(TEN_BITS_MAX),
    OPTION_ARG,
    {"sendlen", BASIC_ARG_INTEGER, .min = 1, .max = BYTES_MAX, .help = "how many bytes"},
    {"data", BASIC_ARG_DATA, .min = 0, .max = 255, .help = "the bytes"},
};
const basic_arg_spec_t i2c_read_args[] = {
    ADDRESS_ARG(TEN_BITS_MAX),
    OPTION_ARG,
    {"rcvlen", BASIC_ARG_INTEGER, .min = 1, .max = BYTES_MAX, .help = "how many bytes"},
    {"rcvbuf", BASIC_ARG_STORE, .help = "where they go"},
};
const basic_arg_spec_t i2c_check_args[] = {ADDRESS_ARG(SEVEN_BITS_MAX)};

static struct {
    uint32_t timeout_ms[HAL_I2C_PORTS]; // 0: none
    enum { RESULT_OK, RESULT_NO_ACKNOWLEDGE, RESULT_TIMEOUT } result;
} i2c;

void i2c_clear(void) {
    i2c.result = RESULT_OK;
}

err_t i2c_result(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)args;
    (void)count;
    result->integer = i2c.result;
    return ERR_OK;
}

err_t i2c_setpin(const basic_arg_t *args, size_t count) {
    (void)count;
    const unsigned gpios[] = {(unsigned)args[0].integer, (unsigned)args[1].integer};
    err_t err = io_bus_set_pins(IO_BUS_I2C + (io_bus_t)args[2].integer, gpios);
    if (err == ERR_OK) {
        setpin_forget_interrupt(gpios[0]);
        setpin_forget_interrupt(gpios[1]);
    }
    return err;
}

// ---- Transfers ----------------------------------------------------------------------------------

// Carries a transfer out while the background goes on. Ctrl-C gives it up as the timeout does.
static void run(unsigned port, const hal_i2c_transfer_t *transfer) {
    uint64_t now_us = hal_time_us();
    uint64_t end_us = UINT64_MAX;
    if (i2c.timeout_ms[port] != 0) {
        end_us = now_us + i2c.timeout_ms[port] * UINT64_C(1000);
    }
    hal_i2c_start(port, transfer);
    hal_i2c_state_t state = hal_i2c_poll(port);
    while (state == HAL_I2C_BUSY) {
        now_us = hal_time_us();
        if (now_us >= end_us || !basic_wait(now_us + POLL_US)) {
            hal_i2c_abort(port);
            i2c.result = RESULT_TIMEOUT;
            return;
        }
        state = hal_i2c_poll(port);
    }
    i2c.result = state == HAL_I2C_DONE ? RESULT_OK : RESULT_NO_ACKNOWLEDGE;
}

// What READ and WRITE have in common. Error: the address has more bits than are said.
static err_t take_option(const basic_arg_t *args, hal_i2c_transfer_t *transfer) {
    int64_t address = args[0].integer;
    transfer->address = (uint16_t)address;
    transfer->keep = (args[1].integer & OPTION_KEEP) != 0;
    transfer->ten_bits = (args[1].integer & OPTION_TEN_BITS) != 0;
    transfer->size = (size_t)args[2].integer;
    if (address > SEVEN_BITS_MAX && !transfer->ten_bits) {
        return err_raise(ERR_ARGUMENT,
                         "addr: %d is invalid (valid is 0 to %d, with option 2 or 3 to %d)",
                         (int)address, SEVEN_BITS_MAX, TEN_BITS_MAX);
    }
    return ERR_OK;
}

// A string or an array may be longer than what is sent of it; numbers may not be more.
static err_t take_data(const basic_arg_t *data, size_t size, uint8_t *bytes) {
    bool is_list = data->data.count > 1;
    if (data->integer < (int64_t)size || (is_list && data->integer > (int64_t)size)) {
        return err_raise(ERR_ARGUMENT, "data: %u bytes, sendlen is %u", (unsigned)data->integer,
                         (unsigned)size);
    }
    for (size_t i = 0; i < size; i++) {
        int64_t byte = basic_data_number(data, i);
        if (byte < 0 || byte > UINT8_MAX) {
            return err_raise(ERR_ARGUMENT, "data: a byte is out of range (valid is 0 to 255)");
        }
        bytes[i] = (uint8_t)byte;
    }
    return ERR_OK;
}

static err_t write(unsigned port, const basic_arg_t *args) {
    uint8_t bytes[BYTES_MAX];
    hal_i2c_transfer_t transfer = {.send = bytes};
    err_t err = io_bus_check_open(IO_BUS_I2C + port);
    err = err == ERR_OK ? take_option(args, &transfer) : err;
    err = err == ERR_OK ? take_data(&args[3], transfer.size, bytes) : err;
    if (err == ERR_OK) {
        run(port, &transfer);
    }
    return err;
}

static err_t check_room(const basic_arg_t *variable, size_t size) {
    if (variable->integer < (int64_t)size) {
        return err_raise(ERR_ARGUMENT, "rcvbuf: has room for %u, rcvlen is %u",
                         (unsigned)variable->integer, (unsigned)size);
    }
    return ERR_OK;
}

static err_t read(unsigned port, const basic_arg_t *args) {
    uint8_t bytes[BYTES_MAX];
    hal_i2c_transfer_t transfer = {.receive = bytes};
    err_t err = io_bus_check_open(IO_BUS_I2C + port);
    err = err == ERR_OK ? take_option(args, &transfer) : err;
    err = err == ERR_OK ? check_room(&args[3], transfer.size) : err;
    if (err != ERR_OK) {
        return err;
    }
    run(port, &transfer);
    for (size_t i = 0; i < transfer.size && i2c.result == RESULT_OK; i++) {
        basic_store_number(&args[3], i, bytes[i]);
    }
    return ERR_OK;
}

static err_t check(unsigned port, const basic_arg_t *args) {
    uint8_t byte;
    hal_i2c_transfer_t transfer = {
        .address = (uint16_t)args[0].integer, .receive = &byte, .size = 1};
    err_t err = io_bus_check_open(IO_BUS_I2C + port);
    if (err == ERR_OK) {
        run(port, &transfer);
    }
    return err;
}

static err_t open(unsigned port, const basic_arg_t *args) {
    err_t err = io_bus_open_i2c(IO_BUS_I2C + port, (uint32_t)args[0].integer);
    if (err == ERR_OK) {
        i2c.timeout_ms[port] = (uint32_t)args[1].integer;
    }
    return err;
}

// ---- Handlers -----------------------------------------------------------------------------------

err_t i2c_open(const basic_arg_t *args, size_t count) {
    (void)count;
    return open(0, args);
}

err_t i2c_open_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return open(1, args);
}

err_t i2c_write(const basic_arg_t *args, size_t count) {
    (void)count;
    return write(0, args);
}

err_t i2c_write_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return write(1, args);
}

err_t i2c_read(const basic_arg_t *args, size_t count) {
    (void)count;
    return read(0, args);
}

err_t i2c_read_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return read(1, args);
}

err_t i2c_check(const basic_arg_t *args, size_t count) {
    (void)count;
    return check(0, args);
}

err_t i2c_check_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return check(1, args);
}

err_t i2c_close(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return io_bus_close(IO_BUS_I2C);
}

err_t i2c_close_2(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return io_bus_close(IO_BUS_I2C2);
}
