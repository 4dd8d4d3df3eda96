// Functions of the machine and of the program itself. Context: main loop.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "errors.h"
#include "functions.h"
#include "hal/hal.h"
#include "keys.h"
#include "program.h"
#include "variables.h"
#include "vm.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)
#define ERRNO_GENERAL 16 // MMBasic's number for nearly all errors

static double timer_offset_ms;

static double now_ms(void) {
    return (double)hal_time_us() / 1000.0;
}

void functions_set_timer(double value_ms) {
    timer_offset_ms = value_ms - now_ms();
}

FUNCTION(timer) {
    (void)arguments;
    (void)count;
    value_set_number(result, now_ms() + timer_offset_ms);
}

FUNCTION(pos) {
    (void)arguments;
    (void)count;
    value_set_integer(result, (int64_t)console_column() + 1);
}

// Keys that have no character have the codes that MMBasic gives them: 128 is up, 145 F1, 177
// Shift-F1.
FUNCTION(inkey) {
    (void)arguments;
    (void)count;
    int code = keys_take();
    bool function_key = (code & 0xFFF) >= KEYS_F1 && (code & 0xFFF) <= KEYS_F12;
    bool none = (code & 0xFFF) >= KEYS_PASTE_BEGIN;
    char *key = memory_text(1);
    *key = (char)(code | (function_key && code & KEYS_SHIFT ? 0x20 : 0));
    value_set_text(result, key, none ? 0 : 1);
}

FUNCTION(mm_device) {
    (void)arguments;
    (void)count;
    value_set_text(result, hal_board_name(), strlen(hal_board_name()));
}

// 1.02.03 of version 1.2.3 as MMBasic does it: 1.0203.
FUNCTION(mm_ver) {
    (void)arguments;
    (void)count;
    const char *text = hal_firmware_version();
    double place = 1.0;
    double version = 0.0;
    while (*text >= '0' && *text <= '9') {
        char *end;
        version += (double)strtoul(text, &end, 10) / place;
        place *= 100.0;
        text = *end == '.' ? end + 1 : end;
    }
    value_set_number(result, version);
}

FUNCTION(mm_errmsg) {
    (void)arguments;
    (void)count;
    value_set_text(result, vm.error_text, strlen(vm.error_text));
}

FUNCTION(mm_cmdline) {
    (void)arguments;
    (void)count;
    size_t length;
    const char *argument = program_argument(&length);
    value_set_text(result, argument, length);
}

// MMBasic numbers the errors of files as its file systems do, and gives all others one number.
static int64_t number_of(err_t code) {
    static const struct {
        err_t code;
        uint8_t number;
    } numbers[] = {
        {ERR_STORAGE_FAILED, 1}, {ERR_FILES_DAMAGED, 2}, {ERR_STORAGE_BUSY, 3},
        {ERR_FILE_NOT_FOUND, 4}, {ERR_NOT_A_FOLDER, 5},  {ERR_FILE_BAD_NAME, 6},
        {ERR_DISK_FULL, 7},      {ERR_IS_A_FOLDER, 7},   {ERR_FOLDER_IN_USE, 7},
        {ERR_FILE_MODE, 7},      {ERR_FILE_EXISTS, 8},
    };
    for (size_t i = 0; i < COUNT_OF_ARRAY(numbers); i++) {
        if (numbers[i].code == code) {
            return numbers[i].number;
        }
    }
    return ERRNO_GENERAL;
}

FUNCTION(mm_errno) {
    (void)arguments;
    (void)count;
    value_set_integer(result, vm.error_text[0] != '\0' ? number_of(vm.error_code) : 0);
}

FUNCTION(bound) {
    if (arguments[0].type != VALUE_ARRAY) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    const variables_array_t *array = arguments[0].data;
    int64_t dimension = count > 1 ? arguments[1].integer : 1;
    if (dimension == 0) {
        value_set_integer(result, array->base);
        return;
    }
    if (dimension < 0 || dimension > array->dimensions) {
        errors_fail(ERR_DIMENSIONS);
    }
    value_set_integer(result, array->extent[dimension - 1] + (int64_t)array->base - 1);
}

// The condition is truncated: 0.9 is false here, unlike in IF.
FUNCTION(choice) {
    (void)count;
    *result = arguments[trunc(arguments[0].number) != 0.0 ? 1 : 2];
}
