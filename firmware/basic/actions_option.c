// OPTION for what outlives power-off, at run time. Context: main loop.
#include "actions.h"
#include "channels.h"
#include "console.h"
#include "errors.h"
#include "function_keys.h"
#include "files/files.h"
#include "hal/hal.h"
#include "lexer.h"
#include "options.h"

#define ACTION_BODY(name) void actions_##name(value_t *arguments, unsigned count)
#define DISPLAY_MAX 255
#define DISPLAY_LINES_MIN 2
#define DISPLAY_COLUMNS_MIN 20
#define BREAK_MAX 255

static void keep(options_t option, int64_t value) {
    if (options_set(option, value) != ERR_OK) {
        errors_fail_raised();
    }
}

static unsigned size_in(const char *name, const value_t *value, unsigned least, unsigned most) {
    int64_t size = value_to_integer(value);
    if (size < least || size > most) {
        errors_fail_with(ERR_ARGUMENT, "%s: %ld is invalid (valid is %u to %u)", name, (long)size,
                         least, most);
    }
    return (unsigned)size;
}

// option, value
ACTION_BODY(option_keep) {
    (void)count;
    int64_t value = value_to_integer(&arguments[1]);
    if (arguments[0].integer == OPTIONS_BREAK) {
        value = size_in("key", &arguments[1], 0, BREAK_MAX);
    } else if (arguments[0].integer == OPTIONS_TAB && value != 2 && value != 3 && value != 4 &&
               value != 8) {
        errors_fail_with(ERR_ARGUMENT, "%ld is invalid (valid is 2, 3, 4 or 8)", (long)value);
    }
    keep((options_t)arguments[0].integer, value);
}

ACTION_BODY(option_display) {
    unsigned lines = size_in("lines", &arguments[0], DISPLAY_LINES_MIN, DISPLAY_MAX);
    unsigned columns = count < 2
                           ? console_columns()
                           : size_in("columns", &arguments[1], DISPLAY_COLUMNS_MIN, DISPLAY_MAX);
    keep(OPTIONS_DISPLAY, OPTIONS_DISPLAY_VALUE(lines, columns));
}

ACTION_BODY(option_list) {
    (void)arguments;
    (void)count;
    options_list();
    function_keys_list();
}

ACTION_BODY(option_key) {
    (void)count;
    const value_t *text = &arguments[1];
    if (text->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    if (text->length > FUNCTION_KEYS_TEXT_MAX) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    if (function_keys_set((unsigned)arguments[0].integer, text->text, text->length) != ERR_OK) {
        errors_fail_raised();
    }
}

ACTION_BODY(option_reset) {
    (void)arguments;
    (void)count;
    if (options_reset() != ERR_OK || function_keys_reset() != ERR_OK) {
        errors_fail_raised();
    }
}

// FORMAT drive$
ACTION_BODY(option_format) {
    (void)count;
    if (arguments->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    if (!lexer_same(arguments->text, arguments->length, "A:")) {
        errors_fail_with(ERR_ARGUMENT, "The drive is \"A:\"");
    }
    if (!hal_storage_is_writable()) {
        errors_fail(ERR_STORAGE_BUSY);
    }
    channels_end_program();
    if (files_format() != ERR_OK) {
        errors_fail_raised();
    }
    options_start();
}
