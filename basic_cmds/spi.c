// SPI and SPI2: SETPIN, OPEN, WRITE, READ, CLOSE and the function SPI(). Context: main loop.
#include "basic_cmds/spi.h"

#include "basic_cmds/setpin.h"
#include "io/io.h"
#include "io/io_bus.h"

#define LOOK_EVERY_US 500u // at the console and the background, during a transfer
#define WORDS_MAX 131068   // more elements has no array

const basic_arg_spec_t spi_setpin_args[] = {
    {"rx", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "receive: GP0, GP4, GP16, GP20 for SPI, GP8, GP12, GP28 for SPI2"},
    {"tx", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "transmit: GP3, GP7, GP19 for SPI, GP11, GP15, GP27 for SPI2"},
    {"clk", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "clock: GP2, GP6, GP18, GP22 for SPI, GP10, GP14, GP26 for SPI2"},
    {"bus", BASIC_ARG_CHOICE, BASIC_ARG_SELECTS, .choices = "SPI|SPI2", .help = "the bus"},
};
const basic_arg_spec_t spi_open_args[] = {
    {"speed", BASIC_ARG_INTEGER, .min = HAL_SPI_HZ_MIN, .max = HAL_SPI_HZ_MAX, .unit = "Hz",
     .help = "of the clock; the next one below that the board can make"},
    {"mode", BASIC_ARG_INTEGER, .min = 0, .max = 3,
     .help = "0, 1: the clock is low at rest, 2, 3: high; 0, 2: data are taken at its first edge, "
             "1, 3: at the second"},
    {"bits", BASIC_ARG_INTEGER, BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT, .min = HAL_SPI_BITS_MIN,
     .max = HAL_SPI_BITS_MAX, .fallback = 8, .help = "of a word, the highest first"},
};
const basic_arg_spec_t spi_write_args[] = {
    {"nbr", BASIC_ARG_INTEGER, .min = 1, .max = WORDS_MAX, .help = "how many words"},
    {"data", BASIC_ARG_DATA, .help = "the words"},
};
const basic_arg_spec_t spi_read_args[] = {
    {"nbr", BASIC_ARG_INTEGER, .min = 1, .max = WORDS_MAX,
     .help = "how many words; zeros are sent for them"},
    {"array", BASIC_ARG_STORE, .help = "where they go; a string takes eight bits of each"},
};
const basic_arg_spec_t spi_exchange_args[] = {
    {"data", BASIC_ARG_INTEGER, .min = 0, .max = (1 << HAL_SPI_BITS_MAX) - 1, .help = "the word"},
};

static uint8_t bits[HAL_SPI_PORTS]; // of a word

err_t spi_setpin(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned gpios[IO_BUS_PINS_MAX];
    for (unsigned i = 0; i < IO_BUS_PINS_MAX; i++) {
        gpios[i] = (unsigned)args[i].integer;
    }
    err_t err = io_bus_set_pins(IO_BUS_SPI + (io_bus_t)args[IO_BUS_PINS_MAX].integer, gpios);
    for (unsigned i = 0; err == ERR_OK && i < IO_BUS_PINS_MAX; i++) {
        setpin_forget_interrupt(gpios[i]);
    }
    return err;
}

// ---- Transfers ----------------------------------------------------------------------------------

// Words both ways: `send` NULL sends zeros, `store` NULL drops what comes.
typedef struct {
    const basic_arg_t *send;
    const basic_arg_t *store;
    size_t size;
    size_t sent, got;
} transfer_t;

static void take(unsigned port, transfer_t *transfer) {
    uint16_t words[HAL_SPI_UNDER_WAY];
    size_t count = hal_spi_receive(port, words, HAL_SPI_UNDER_WAY);
    for (size_t i = 0; i < count; i++) {
        if (transfer->store != NULL) {
            basic_store_number(transfer->store, transfer->got, words[i]);
        }
        transfer->got++;
    }
}

static void give(unsigned port, transfer_t *transfer) {
    while (transfer->sent < transfer->size && transfer->sent - transfer->got < HAL_SPI_UNDER_WAY) {
        int64_t word =
            transfer->send != NULL ? basic_data_number(transfer->send, transfer->sent) : 0;
        hal_spi_send(port, (uint16_t)word);
        transfer->sent++;
    }
}

// Carries a transfer out while the background goes on; after Ctrl-C what is under way is the last.
static void run(unsigned port, transfer_t *transfer) {
    uint64_t look_us = hal_time_us() + LOOK_EVERY_US;
    while (transfer->got < transfer->size) {
        give(port, transfer);
        size_t before = transfer->got;
        take(port, transfer);
        uint64_t now_us = hal_time_us();
        if (now_us >= look_us) {
            look_us = now_us + LOOK_EVERY_US;
            transfer->size = basic_wait(now_us) ? transfer->size : transfer->sent;
        } else if (transfer->got == before) {
            hal_wait_us(1);
        }
    }
}

// A string or an array may be longer than what is sent of it; numbers may not be more.
static err_t check_data(unsigned port, const basic_arg_t *data, size_t size) {
    bool is_list = data->data.count > 1;
    if (data->integer < (int64_t)size || (is_list && data->integer > (int64_t)size)) {
        return err_raise(ERR_ARGUMENT, "data: %u words, nbr is %u", (unsigned)data->integer,
                         (unsigned)size);
    }
    for (size_t i = 0; i < size; i++) {
        int64_t word = basic_data_number(data, i);
        if (word < 0 || word >> bits[port] != 0) {
            return err_raise(ERR_ARGUMENT, "data: a word is out of range (valid is 0 to %u)",
                             (1u << bits[port]) - 1);
        }
    }
    return ERR_OK;
}

static err_t write(unsigned port, const basic_arg_t *args) {
    transfer_t transfer = {.send = &args[1], .size = (size_t)args[0].integer};
    err_t err = io_bus_check_open(IO_BUS_SPI + port);
    err = err == ERR_OK ? check_data(port, &args[1], transfer.size) : err;
    if (err == ERR_OK) {
        run(port, &transfer);
    }
    return err;
}

static err_t read(unsigned port, const basic_arg_t *args) {
    transfer_t transfer = {.store = &args[1], .size = (size_t)args[0].integer};
    err_t err = io_bus_check_open(IO_BUS_SPI + port);
    if (err == ERR_OK && args[1].integer < (int64_t)transfer.size) {
        return err_raise(ERR_ARGUMENT, "array: has room for %u, nbr is %u",
                         (unsigned)args[1].integer, (unsigned)transfer.size);
    }
    if (err == ERR_OK) {
        run(port, &transfer);
    }
    return err;
}

static err_t exchange(unsigned port, const basic_arg_t *args, basic_value_t *result) {
    err_t err = io_bus_check_open(IO_BUS_SPI + port);
    if (err == ERR_OK && args[0].integer >> bits[port] != 0) {
        return err_raise(ERR_ARGUMENT, "data: %u is invalid (valid is 0 to %u)",
                         (unsigned)args[0].integer, (1u << bits[port]) - 1);
    }
    if (err != ERR_OK) {
        return err;
    }
    uint16_t word;
    hal_spi_send(port, (uint16_t)args[0].integer);
    while (hal_spi_receive(port, &word, 1) == 0) {
        hal_wait_us(1); // 2 ms at worst
    }
    result->integer = word;
    return ERR_OK;
}

static err_t open(unsigned port, const basic_arg_t *args) {
    hal_spi_t settings = {(uint32_t)args[0].integer, (uint8_t)args[1].integer,
                          (uint8_t)args[2].integer};
    err_t err = io_bus_open_spi(IO_BUS_SPI + port, &settings);
    if (err == ERR_OK) {
        bits[port] = settings.bits;
    }
    return err;
}

// ---- Handlers -----------------------------------------------------------------------------------

err_t spi_open(const basic_arg_t *args, size_t count) {
    (void)count;
    return open(0, args);
}

err_t spi_open_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return open(1, args);
}

err_t spi_write(const basic_arg_t *args, size_t count) {
    (void)count;
    return write(0, args);
}

err_t spi_write_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return write(1, args);
}

err_t spi_read(const basic_arg_t *args, size_t count) {
    (void)count;
    return read(0, args);
}

err_t spi_read_2(const basic_arg_t *args, size_t count) {
    (void)count;
    return read(1, args);
}

err_t spi_exchange(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    return exchange(0, args, result);
}

err_t spi_exchange_2(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    return exchange(1, args, result);
}

err_t spi_close(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return io_bus_close(IO_BUS_SPI);
}

err_t spi_close_2(const basic_arg_t *args, size_t count) {
    (void)args;
    (void)count;
    return io_bus_close(IO_BUS_SPI2);
}
