// MM.INFO(...) and MM.WATCHDOG: the board, its memory and its pins. Context: main loop.
#include <string.h>

#include "args.h"
#include "base/base.h"
#include "choices.h"
#include "errors.h"
#include "files/files.h"
#include "functions.h"
#include "hal/hal.h"
#include "hal/hal_io.h"
#include "memory.h"
#include "program.h"
#include "vm.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)
#define UNUSED_ARGUMENTS                                                                           \
    (void)arguments;                                                                               \
    (void)count

static void set_constant_text(value_t *result, const char *text) {
    value_set_text(result, text, strlen(text));
}

FUNCTION(mm_watchdog) {
    UNUSED_ARGUMENTS;
    hal_start_t reason = hal_start_reason();
    value_set_integer(result, reason == HAL_START_WATCHDOG || reason == HAL_START_HUNG);
}

FUNCTION(info_boot) {
    static const char *const texts[] = {
        [HAL_START_POWER] = "Power On",        [HAL_START_RESTART] = "Restart",
        [HAL_START_WATCHDOG] = "S/W Watchdog", [HAL_START_HUNG] = "H/W Watchdog",
        [HAL_START_FAULT] = "Fault",
    };
    UNUSED_ARGUMENTS;
    set_constant_text(result, texts[hal_start_reason()]);
}

FUNCTION(info_cpuspeed) {
    UNUSED_ARGUMENTS;
    value_set_integer(result, hal_clock_hz());
}

FUNCTION(info_uptime) {
    UNUSED_ARGUMENTS;
    value_set_number(result, (double)hal_time_us() / 1e6);
}

FUNCTION(info_line) {
    UNUSED_ARGUMENTS;
    value_set_integer(result, vm_line());
}

FUNCTION(info_heap) {
    UNUSED_ARGUMENTS;
    value_set_integer(result, (int64_t)memory_free());
}

FUNCTION(info_program) {
    UNUSED_ARGUMENTS;
    value_set_integer(result, (int64_t)program_length());
}

// ---- The disk -----------------------------------------------------------------------------------

static void expect_word(const value_t *value, const char *word) {
    if (choices_find(word, value->text, value->length) < 0) {
        errors_fail(ERR_SYNTAX);
    }
}

static void disk_space(uint32_t *total, uint32_t *used) {
    if (files_space(total, used) != ERR_OK) {
        errors_fail_raised();
    }
}

// MM.INFO(FREE SPACE)
FUNCTION(info_free) {
    (void)count;
    uint32_t total;
    uint32_t used;
    expect_word(arguments, "SPACE");
    disk_space(&total, &used);
    value_set_integer(result, (int64_t)total - used);
}

// MM.INFO(DISK SIZE)
FUNCTION(info_disk) {
    (void)count;
    uint32_t total;
    uint32_t used;
    expect_word(arguments, "SIZE");
    disk_space(&total, &used);
    value_set_integer(result, total);
}

// ---- Pins ---------------------------------------------------------------------------------------

static unsigned pin_of(const value_t *value) {
    static const basic_arg_spec_t spec = {
        .name = "pin", .kind = BASIC_ARG_PIN, .flags = BASIC_ARG_BOARD_NUMBER};
    basic_arg_t pin;
    size_t count;
    args_deliver(&spec, 1, value, 1, &pin, &count);
    return (unsigned)pin.integer;
}

// MM.INFO(PIN p): who uses it.
FUNCTION(info_pin) {
    (void)count;
    const char *owner = pins_owner(pin_of(arguments));
    set_constant_text(result, owner != NULL ? owner : "Unused");
}

// MM.INFO(PINNO GPn): its number on the board, 0 if it has none.
FUNCTION(info_pinno) {
    (void)count;
    value_set_integer(result, pins_board_number(pin_of(arguments)));
}
