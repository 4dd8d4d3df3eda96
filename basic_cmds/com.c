// Serial ports as channels: OPEN "COM1:9600,buffer,sub,level,EVEN,S2,7BIT" AS #1. Context: main
// loop.
#include "basic_cmds/com.h"

#include <string.h>

#include "basic_cmds/events.h"
#include "basic_cmds/setpin.h"
#include "io/io.h"
#include "io/io_serial.h"

#define BUFFER_SIZE 256 // if none is said, as in MMBasic
#define FIELD_SIZE 34

const basic_arg_spec_t com_setpin_args[] = {
    {"receive", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "input: GP1, GP13, GP17 for COM1, GP5, GP9, GP21 for COM2"},
    {"send", BASIC_ARG_PIN, BASIC_ARG_BOARD_NUMBER,
     .help = "output: GP0, GP12, GP16, GP28 for COM1, GP4, GP8, GP20 for COM2"},
    {"port", BASIC_ARG_CHOICE, BASIC_ARG_SELECTS, .choices = "COM1|COM2",
     .help = "the port; COM1 ends the console on GP0 and GP1 while it is open"},
};

static struct {
    uint32_t read;     // bytes the program has taken since OPEN
    uint32_t seen;     // bytes received up to the last event
    uint32_t level;    // bytes waiting that are worth an event
    bool raises_event; // a SUB is to be called
} ports[HAL_SERIAL_PORTS];

err_t com_setpin(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned receive_gpio = (unsigned)args[0].integer;
    unsigned send_gpio = (unsigned)args[1].integer;
    err_t err = io_serial_set_pins((unsigned)args[2].integer, receive_gpio, send_gpio);
    if (err == ERR_OK) {
        setpin_forget_interrupt(receive_gpio);
        setpin_forget_interrupt(send_gpio);
    }
    return err;
}

void com_background(void) {
    for (unsigned port = 0; port < HAL_SERIAL_PORTS; port++) {
        if (!ports[port].raises_event) {
            continue;
        }
        uint32_t waiting = (uint32_t)hal_serial_waiting(port);
        uint32_t received = ports[port].read + waiting;
        if (waiting >= ports[port].level && received != ports[port].seen) {
            ports[port].seen = received;
            basic_raise_event(EVENTS_COM + port);
        }
    }
}

void com_clear(void) {
    memset(ports, 0, sizeof ports);
}

// ---- What stands behind OPEN --------------------------------------------------------------------

typedef struct {
    hal_serial_t serial;
    basic_routine_t routine;
    uint32_t level;
    unsigned positions; // fields without a name so far
} request_t;

// Takes a number in a range. The message names what it was meant for.
static err_t take_number(const char *name, const char *field, int64_t min, int64_t max,
                         uint32_t *value) {
    num_t number;
    const char *end = num_parse(field, field + strlen(field), false, &number);
    bool good = end != NULL && *end == '\0' && number.is_integer && number.integer >= min &&
                number.integer <= max;
    if (!good) {
        return err_raise(ERR_ARGUMENT, "%s: %s is invalid (valid is %d to %d)", name, field,
                         (int)min, (int)max);
    }
    *value = (uint32_t)number.integer;
    return ERR_OK;
}

// True if the field is one of the words for the form of a byte.
static bool take_form(const char *field, hal_serial_t *serial) {
    static const struct {
        const char *word;
        uint8_t data_bits, stop_bits;
        int8_t parity;
    } forms[] = {
        {"7BIT", 7, 0, -1},
        {"8BIT", 8, 0, -1},
        {"S1", 0, 1, -1},
        {"S2", 0, 2, -1},
        {"NONE", 0, 0, HAL_PARITY_NONE},
        {"EVEN", 0, 0, HAL_PARITY_EVEN},
        {"ODD", 0, 0, HAL_PARITY_ODD},
    };
    for (size_t i = 0; i < COUNT_OF_ARRAY(forms); i++) {
        if (strcmp(field, forms[i].word) == 0) {
            serial->data_bits = forms[i].data_bits != 0 ? forms[i].data_bits : serial->data_bits;
            serial->stop_bits = forms[i].stop_bits != 0 ? forms[i].stop_bits : serial->stop_bits;
            if (forms[i].parity >= 0) {
                serial->parity = (hal_parity_t)forms[i].parity;
            }
            return true;
        }
    }
    return false;
}

// A field in its place: baud, buffer, sub, level. Blank ones are left out.
static err_t take_position(const char *field, request_t *request) {
    uint32_t size;
    err_t err = ERR_OK;
    unsigned position = request->positions++;
    if (*field == '\0') {
        return ERR_OK;
    }
    switch (position) {
    case 0:
        return take_number("baud", field, HAL_SERIAL_BAUD_MIN, HAL_SERIAL_BAUD_MAX,
                           &request->serial.baud);
    case 1:
        err = take_number("buffer", field, 1, HAL_SERIAL_RECEIVE_SIZE, &size);
        request->serial.receive_size = err == ERR_OK ? (uint16_t)size : BUFFER_SIZE;
        return err;
    case 2:
        return basic_find_routine((basic_text_t){field, strlen(field)}, &request->routine);
    case 3:
        return take_number("level", field, 1, HAL_SERIAL_RECEIVE_SIZE, &request->level);
    default:
        return err_raise(ERR_ARGUMENT, "%s is not known in OPEN \"COMn:\"", field);
    }
}

// The fields between commas, in capitals and without blanks.
static err_t take_fields(basic_text_t text, request_t *request) {
    size_t i = 0;
    err_t err = ERR_OK;
    while (i <= text.length && err == ERR_OK) {
        char field[FIELD_SIZE];
        size_t length = 0;
        for (; i < text.length && text.text[i] != ','; i++) {
            if (text.text[i] != ' ' && length < sizeof field - 1) {
                field[length++] = letters_upper(text.text[i]);
            }
        }
        field[length] = '\0';
        if (!take_form(field, &request->serial)) {
            err = take_position(field, request);
        }
        i++;
    }
    return err;
}

// ---- The device ---------------------------------------------------------------------------------

static err_t open(basic_text_t text, basic_device_mode_t mode, int *handle) {
    (void)mode; // a port goes both ways
    int64_t number = text.length > 3 ? text.text[3] - '0' : 0;
    if (number < 1 || number > (int64_t)HAL_SERIAL_PORTS ||
        (text.length > 4 && text.text[4] != ':')) {
        return err_raise(ERR_ARGUMENT, "%.*s is no port (valid is COM1, COM2)", (int)text.length,
                         text.text);
    }
    unsigned port = (unsigned)number - 1;
    size_t skip = text.length > 4 ? 5 : 4;
    request_t request = {.serial = {9600, 8, 1, HAL_PARITY_NONE, BUFFER_SIZE}, .level = 1};
    err_t err = take_fields((basic_text_t){text.text + skip, text.length - skip}, &request);
    err = err == ERR_OK ? io_serial_open(port, &request.serial) : err;
    if (err != ERR_OK) {
        return err;
    }
    ports[port].read = ports[port].seen = 0;
    ports[port].level = request.level;
    ports[port].raises_event = request.routine != 0;
    basic_set_event(EVENTS_COM + port, request.routine);
    *handle = (int)port;
    return ERR_OK;
}

static err_t close(int handle) {
    unsigned port = (unsigned)handle;
    ports[port].raises_event = false;
    basic_set_event(EVENTS_COM + port, 0);
    io_serial_close(port);
    return ERR_OK;
}

static err_t check_open(int handle) {
    bool open_still = io_serial_is_open((unsigned)handle);
    return open_still ? ERR_OK : err_raise(ERR_COM_LOST, "%d", handle + 1);
}

static err_t write(int handle, const void *bytes, size_t size, size_t *took) {
    err_t err = check_open(handle);
    if (err == ERR_OK) {
        *took = hal_serial_write((unsigned)handle, bytes, size);
    }
    return err;
}

static err_t read(int handle, void *bytes, size_t size, size_t *got) {
    err_t err = check_open(handle);
    if (err == ERR_OK) {
        *got = hal_serial_read((unsigned)handle, bytes, size);
        ports[handle].read += (uint32_t)*got;
    }
    return err;
}

static bool at_end(int handle) {
    return hal_serial_waiting((unsigned)handle) == 0;
}

static uint32_t room(int handle) {
    return (uint32_t)hal_serial_room((unsigned)handle);
}

static uint32_t waiting(int handle) {
    return (uint32_t)hal_serial_waiting((unsigned)handle);
}

static err_t flush(int handle) {
    while (!hal_serial_is_sent((unsigned)handle) && !basic_break_pending()) {
        hal_idle(hal_time_us() + 1000);
    }
    return ERR_OK;
}

const basic_device_t com_device = {
    .name = "COM",
    .open = open,
    .close = close,
    .write = write,
    .read = read,
    .at_end = at_end,
    .length = room,
    .position = waiting,
    .flush = flush,
};
