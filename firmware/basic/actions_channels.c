// OPEN, CLOSE, SEEK, FLUSH, PRINT #, INPUT # and LINE INPUT # at run time. Context: main loop.
#include <string.h>

#include "actions.h"
#include "channels.h"
#include "errors.h"
#include "memory.h"
#include "number_text.h"

#define ACTION_BODY(name) void actions_##name(value_t *arguments, unsigned count)

static void expect_text(const value_t *value) {
    if (value->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
}

ACTION_BODY(open) {
    (void)count;
    expect_text(&arguments[0]);
    basic_text_t name = {arguments[0].text, arguments[0].length};
    channels_open(channels_number(&arguments[2]), name, (basic_device_mode_t)arguments[1].integer);
}

ACTION_BODY(close) {
    if (count == 0) {
        channels_close_open();
    } else {
        channels_close(channels_number(&arguments[0]));
    }
}

ACTION_BODY(seek) {
    (void)count;
    channels_seek(channels_number(&arguments[0]), value_to_integer(&arguments[1]));
}

ACTION_BODY(flush) {
    (void)count;
    channels_flush(channels_number(&arguments[0]));
}

// ---- PRINT # ------------------------------------------------------------------------------------

// The line being put together, in the scratch.
static struct {
    char *text;
    size_t length;
    unsigned column; // where it starts on the channel
} line;

static void append(const char *text, size_t length) {
    memcpy(line.text + line.length, text, length);
    line.length += length;
}

static unsigned column(void) {
    return channels_column_behind(line.column, line.text, line.length);
}

// A column passed already: on a line of its own.
static void append_tab(const value_t *value) {
    int64_t wanted = value_to_integer(value);
    if (wanted < 1 || wanted > VALUE_STRING_MAX) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    if (column() > (unsigned)wanted - 1) {
        append("\r\n", 2);
    }
    while (column() < (unsigned)wanted - 1) {
        append(" ", 1);
    }
}

static void append_value(const value_t *value) {
    if (value->type == VALUE_STRING) {
        append(value->text, value->length);
        return;
    }
    char text[NUMBER_TEXT_SIZE];
    size_t length = number_text_value(text, value);
    if (text[0] != '-') {
        append(" ", 1);
    }
    append(text, length);
}

// What the values may need at most.
static size_t room_for(const value_t *values, unsigned count) {
    size_t room = 0;
    for (unsigned i = 0; i < count; i++) {
        room += values[i].type == VALUE_STRING ? values[i].length : NUMBER_TEXT_SIZE;
        room += values[i].type == VALUE_NONE ? VALUE_STRING_MAX : 0;
    }
    return room;
}

ACTION_BODY(print_channel) {
    unsigned number = channels_number(&arguments[0]);
    line.column = channels_column(number);
    line.length = 0;
    line.text = memory_text(room_for(arguments + 1, count - 1));
    for (unsigned i = 1; i < count; i++) {
        if (arguments[i].type == VALUE_NONE) {
            append_tab(&arguments[++i]);
        } else {
            append_value(&arguments[i]);
        }
    }
    channels_write(number, line.text, line.length);
}
