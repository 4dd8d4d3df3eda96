// PAUSE, TIMER, RUN, LIST, OPTION, ON ERROR and the like at run time. Context: main loop.
#include <string.h>

#include "actions.h"
#include "code.h"
#include "console.h"
#include "errors.h"
#include "functions.h"
#include "hal/hal.h"
#include "help.h"
#include "memory.h"
#include "pager.h"
#include "program.h"
#include "requests.h"
#include "program_storage.h"
#include "vm.h"

#define ACTION_BODY(name) void actions_##name(value_t *arguments, unsigned count)

void actions_stop_with(vm_request_t request) {
    vm.stop = true;
    vm.request = request;
    static const uint8_t end[] = {OP_END};
    vm.pc = end;
}

ACTION_BODY(end) {
    (void)count;
    actions_stop_with(VM_REQUEST_NONE);
    vm.stop = arguments->integer != 0; // NOEND: not even the end
}

ACTION_BODY(autosave) {
    (void)count;
    actions_stop_with(value_is_true(arguments) ? VM_REQUEST_APPEND : VM_REQUEST_AUTOSAVE);
}

ACTION_BODY(edit) {
    requests_make(VM_REQUEST_EDIT, count != 0 ? arguments : NULL, NULL);
}

ACTION_BODY(timer) {
    (void)count;
    double ms = value_to_number(arguments);
    if (!(ms >= 0)) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    functions_set_timer(ms);
}

ACTION_BODY(randomize) {
    functions_seed(count != 0 ? (uint64_t)value_to_integer(arguments) : hal_time_us());
}

ACTION_BODY(error) {
    if (count == 0) {
        errors_fail_with(ERR_ARGUMENT, "Error");
    }
    if (arguments->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    errors_fail_with(ERR_ARGUMENT, "%.*s", (int)arguments->length, arguments->text);
}

ACTION_BODY(option) {
    (void)count;
    int64_t value = value_to_integer(&arguments[1]);
    switch (arguments[0].integer) {
    case ACTIONS_OPTION_EXPLICIT:
        vm.explicit_names = value != 0;
        break;
    case ACTIONS_OPTION_DEFAULT:
        vm.default_type = (uint8_t)value;
        break;
    case ACTIONS_OPTION_ESCAPE:
        vm.escapes = value != 0;
        break;
    case ACTIONS_OPTION_ANGLE:
        vm.degrees = value != 0;
        break;
    default:
        if (value != 0 && value != 1) {
            errors_fail_with(ERR_ARGUMENT, "%ld is invalid (valid is 0 to 1)", (long)value);
        }
        vm.base = (uint8_t)value;
        break;
    }
}

ACTION_BODY(on_error) {
    (void)count;
    int64_t statements = value_to_integer(&arguments[1]);
    if (statements < 1 || statements > INT32_MAX) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    if (arguments[0].integer != ACTIONS_ERROR_ABORT) {
        vm.error_text[0] = '\0';
    }
    switch (arguments[0].integer) {
    case ACTIONS_ERROR_ABORT:
        vm.on_error = VM_ERROR_ABORT;
        break;
    case ACTIONS_ERROR_IGNORE:
        vm.on_error = VM_ERROR_IGNORE;
        break;
    case ACTIONS_ERROR_SKIP:
        vm.on_error = VM_ERROR_SKIP;
        vm.skip_count = (unsigned)statements;
        break;
    default:
        break;
    }
}

ACTION_BODY(memory) {
    (void)arguments;
    (void)count;
    char text[160];
    size_t total = (size_t)(memory.top - memory.floor);
    size_t code = program_code_size();
    size_t names = (size_t)(memory.top - memory.ceiling) - MEMORY_PROMPT_RESERVE;
    size_t variables = (size_t)(memory.heap - memory.floor) - code + names;
    format_text(text, sizeof text,
                "Flash:  program %u of %u bytes\r\n"
                "Memory: code %u, variables and names %u, free %u of %u bytes\r\n",
                (unsigned)program_length(), PROGRAM_STORAGE_MAX, (unsigned)code,
                (unsigned)variables, (unsigned)memory_free(), (unsigned)total);
    console_print(text);
}

ACTION_BODY(help) {
    (void)count;
    help_print(arguments->text, arguments->length);
}

ACTION_BODY(list) {
    int64_t first = count > 1 ? arguments[1].integer : 1;
    int64_t last = count > 1 ? arguments[2].integer : INT64_MAX;
    const char *text = program_text();
    const char *end = text + program_length();
    pager_start(value_is_true(arguments));
    for (int64_t line = 1; text < end && line <= last; line++) {
        const char *stop = memchr(text, '\n', (size_t)(end - text));
        stop = stop != NULL ? stop : end;
        if (line >= first && !pager_line(text, (size_t)(stop - text))) {
            return;
        }
        text = stop + 1;
    }
}

ACTION_BODY(list_words) {
    (void)count;
    help_print_words(value_is_true(arguments));
}
