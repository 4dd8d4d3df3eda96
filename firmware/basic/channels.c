// Channels: the table of what is open, lines cut from what comes, text kept whole. Context: main
// loop.
#include "channels.h"

#include <string.h>

#include "channel_files.h"
#include "console.h"
#include "errors.h"
#include "hal/hal.h"
#include "lexer.h"

#define TAB_WIDTH 8
#define POLL_US 1000u // until a stream is looked at again
#define READ_SIZE 64  // bytes a line of a file is searched in

typedef struct {
    const basic_device_t *device; // NULL: not open
    int handle;
    uint16_t column; // of the next character written
    bool after_cr;   // of a stream: the LF that may come next belongs to the line read last
} channel_t;

static struct {
    const basic_config_t *config;
    channel_t open[CHANNELS_MAX];
} channels;

void channels_start(const basic_config_t *config) {
    memset(&channels, 0, sizeof channels);
    channels.config = config;
}

unsigned channels_number(const value_t *value) {
    int64_t number = value_to_integer(value);
    if (number < 0 || number > CHANNELS_MAX) {
        errors_fail_with(ERR_ARGUMENT, "file number: %ld is invalid (valid is 1 to %d)",
                         (long)number, CHANNELS_MAX);
    }
    return (unsigned)number;
}

// A channel that is open.
static channel_t *channel_of(unsigned number) {
    if (number == 0 || channels.open[number - 1].device == NULL) {
        errors_fail(ERR_FILE_NOT_OPEN);
    }
    return &channels.open[number - 1];
}

static void check(err_t error) {
    if (error != ERR_OK) {
        errors_fail_raised();
    }
}

// ---- Opening and closing ------------------------------------------------------------------------

static bool is_device(const basic_device_t *device, basic_text_t name) {
    size_t length = strlen(device->name);
    return name.length > length && lexer_same(name.text, length, device->name) &&
           (name.text[length] == ':' || (name.text[length] >= '0' && name.text[length] <= '9'));
}

static const basic_device_t *device_for(basic_text_t name) {
    for (size_t i = 0; i < channels.config->device_count; i++) {
        if (is_device(channels.config->devices[i], name)) {
            return channels.config->devices[i];
        }
    }
    return &channel_files;
}

void channels_open(unsigned number, basic_text_t name, basic_device_mode_t mode) {
    if (number == 0 || channels.open[number - 1].device != NULL) {
        errors_fail(ERR_FILE_ALREADY_OPEN);
    }
    channel_t opened = {.device = device_for(name)};
    check(opened.device->open(name, mode, &opened.handle));
    channels.open[number - 1] = opened;
}

static err_t close(channel_t *channel) {
    const basic_device_t *device = channel->device;
    channel->device = NULL;
    return device->close(channel->handle);
}

void channels_close(unsigned number) {
    check(close(channel_of(number)));
}

void channels_close_open(void) {
    err_t error = ERR_OK;
    for (unsigned i = 0; i < CHANNELS_MAX; i++) {
        if (channels.open[i].device != NULL && error == ERR_OK) {
            error = close(&channels.open[i]);
        }
    }
    check(error);
}

err_t channels_end_program(void) {
    err_t error = ERR_OK;
    for (unsigned i = 0; i < CHANNELS_MAX; i++) {
        err_t now = channels.open[i].device != NULL ? close(&channels.open[i]) : ERR_OK;
        error = now != ERR_OK ? now : error; // the one whose text stands
    }
    return error;
}

// ---- Writing ------------------------------------------------------------------------------------

static void wait_for_device(void) {
    if (console_break_pending()) {
        errors_break();
    }
    console_wait(hal_time_us() + POLL_US);
}

unsigned channels_column_behind(unsigned column, const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\r' || text[i] == '\n') {
            column = 0;
        } else if (text[i] == '\t') {
            column += TAB_WIDTH - column % TAB_WIDTH;
        } else {
            column++;
        }
    }
    return column;
}

void channels_write(unsigned number, const char *text, size_t length) {
    if (number == 0) {
        console_write(text, length);
        return;
    }
    channel_t *channel = channel_of(number);
    size_t sent = 0;
    while (sent < length) {
        size_t took = 0;
        check(channel->device->write(channel->handle, text + sent, length - sent, &took));
        sent += took;
        if (sent < length) {
            wait_for_device();
        }
    }
    channel->column = (uint16_t)channels_column_behind(channel->column, text, length);
}

unsigned channels_column(unsigned number) {
    return number == 0 ? console_column() : channel_of(number)->column;
}

// ---- Reading ------------------------------------------------------------------------------------

static size_t read_some(const channel_t *channel, char *bytes, size_t size) {
    size_t got = 0;
    check(channel->device->read(channel->handle, bytes, size, &got));
    return got;
}

static void go_to(const channel_t *channel, uint32_t position) {
    check(channel->device->seek(channel->handle, position));
}

// Puts the file's position behind the line end that starts `rest` bytes before it.
static void skip_line_end(const channel_t *channel, size_t rest) {
    uint32_t end = channel->device->position(channel->handle) - (uint32_t)rest;
    char pair[2];
    go_to(channel, end);
    size_t got = read_some(channel, pair, 2);
    bool both = got == 2 && pair[0] == '\r' && pair[1] == '\n';
    go_to(channel, end + 1 + both);
}

static size_t read_line_of_file(const channel_t *channel, char *line) {
    uint32_t start = channel->device->position(channel->handle);
    size_t length = 0;
    char part[READ_SIZE];
    for (;;) {
        size_t got = read_some(channel, part, sizeof part);
        size_t i = 0;
        while (i < got && part[i] != '\r' && part[i] != '\n') {
            i++;
        }
        if (length + i > VALUE_STRING_MAX) {
            go_to(channel, start);
            errors_fail(ERR_STRING_TOO_LONG);
        }
        memcpy(line + length, part, i);
        length += i;
        if (i < got) {
            skip_line_end(channel, got - i);
        }
        if (i < got || got == 0) {
            return length;
        }
    }
}

static size_t read_line_of_stream(channel_t *channel, char *line) {
    size_t length = 0;
    while (length < VALUE_STRING_MAX) {
        char c;
        if (read_some(channel, &c, 1) == 0) {
            wait_for_device();
            continue;
        }
        bool second = c == '\n' && channel->after_cr;
        channel->after_cr = c == '\r';
        if (!second && (c == '\r' || c == '\n')) {
            return length;
        }
        if (!second) {
            line[length++] = c;
        }
    }
    return length;
}

size_t channels_read_line(unsigned number, char *line) {
    channel_t *channel = channel_of(number);
    bool is_stream = channel->device->seek == NULL;
    return is_stream ? read_line_of_stream(channel, line) : read_line_of_file(channel, line);
}

// What is there of a channel. The LF of a line end whose CR was taken for a line is not.
static size_t read_behind_line(channel_t *channel, char *bytes, size_t size) {
    size_t got = read_some(channel, bytes, size);
    if (got == 0 || !channel->after_cr) {
        return got;
    }
    channel->after_cr = false;
    if (bytes[0] != '\n') {
        return got;
    }
    memmove(bytes, bytes + 1, got - 1);
    return got - 1 + read_some(channel, bytes + got - 1, size - (got - 1));
}

size_t channels_read(unsigned number, char *bytes, size_t size) {
    if (number != 0) {
        return read_behind_line(channel_of(number), bytes, size);
    }
    size_t got = 0;
    while (got < size && console_has_input()) {
        bytes[got++] = (char)console_take();
    }
    return got;
}

// ---- The rest -----------------------------------------------------------------------------------

bool channels_at_end(unsigned number) {
    if (number == 0) {
        return !console_has_input();
    }
    const channel_t *channel = channel_of(number);
    return channel->device->at_end(channel->handle);
}

uint32_t channels_length(unsigned number) {
    const channel_t *channel = channel_of(number);
    return channel->device->length(channel->handle);
}

uint32_t channels_position(unsigned number) {
    const channel_t *channel = channel_of(number);
    return channel->device->position(channel->handle);
}

void channels_seek(unsigned number, int64_t position) {
    const channel_t *channel = channel_of(number);
    if (channel->device->seek == NULL) {
        errors_fail(ERR_INVALID_HERE);
    }
    int64_t last = (int64_t)channel->device->length(channel->handle) + 1;
    if (position < 1 || position > last) {
        errors_fail_with(ERR_ARGUMENT, "position: %ld is invalid (valid is 1 to %ld)",
                         (long)position, (long)last);
    }
    go_to(channel, (uint32_t)position);
}

void channels_flush(unsigned number) {
    const channel_t *channel = channel_of(number);
    if (channel->device->flush != NULL) {
        check(channel->device->flush(channel->handle));
    }
}
