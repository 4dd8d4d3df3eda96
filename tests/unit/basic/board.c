// A board in memory for the language's unit tests.
#include "board.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "hal/hal.h"
#include "hal/hal_io.h"

#define INPUT_SIZE 40000
#define SHOWN_SIZE 100000
#define LATER_MAX 8
#define ARENA_SIZE (96 * 1024)

board_t board;

static struct {
    char input[INPUT_SIZE];
    size_t received, typed, told;
    struct {
        uint64_t at_us;
        char text[64];
    } later[LATER_MAX];
    size_t later_first, later_count;
    char shown[SHOWN_SIZE];
    size_t shown_length;
    uint8_t flash[HAL_STORAGE_SIZE];
    _Alignas(8) uint8_t arena[ARENA_SIZE];
    basic_rows_t rows;
    basic_config_t config;
} state;

void board_reset(void) {
    memset(&state, 0, sizeof state);
    memset(state.flash, 0xFF, sizeof state.flash);
    board = (board_t){.fail_program_after = -1};
}

static void count_background(void) {
    board.backgrounds++;
    if (board.on_background != NULL) {
        board.on_background();
    }
}

static void count_break(void) {
    board.breaks++;
}

static void count_clear(void) {
    board.clears++;
}

static err_t may_restart(void) {
    return board.busy ? err_raise(ERR_ARGUMENT, "%s", "Busy") : ERR_OK;
}

static void count_error(void) {
    board.errors++;
}

// Takes Ctrl-F while board.controllable, and says so.
static bool take_control(char c) {
    if (!board.controllable || c != '\x06') {
        return false;
    }
    board.controls++;
    board.control_us = board.time_us;
    board.control_writes = board.writes;
    basic_notice("held");
    return true;
}

void board_assignments(const basic_assignment_t *assignments, size_t count) {
    state.rows.assignments = assignments;
    state.rows.assignment_count = count;
}

void board_start(const basic_command_t *commands, size_t command_count,
                 const basic_function_t *functions, size_t function_count) {
    static const basic_rows_t *const tables[] = {&state.rows};
    state.rows.commands = commands;
    state.rows.command_count = command_count;
    state.rows.functions = functions;
    state.rows.function_count = function_count;
    state.config = (basic_config_t){
        .arena = state.arena,
        .arena_size = sizeof state.arena,
        .tables = tables,
        .table_count = 1,
        .background = count_background,
        .on_break = count_break,
        .on_clear = count_clear,
        .on_error = count_error,
        .may_restart = may_restart,
        .on_control = take_control,
        .devices = &board.device,
        .device_count = board.device != NULL,
    };
    basic_start(&state.config);
}

void board_type(const char *bytes, size_t length) {
    memcpy(state.input + state.typed, bytes, length);
    state.typed += length;
}

void board_type_at(uint64_t time_us, const char *text) {
    state.later[state.later_count].at_us = time_us;
    snprintf(state.later[state.later_count++].text, sizeof state.later[0].text, "%s", text);
}

const char *board_shown(void) {
    static char copy[SHOWN_SIZE];
    memcpy(copy, state.shown, state.shown_length);
    copy[state.shown_length] = '\0';
    state.shown_length = 0;
    return copy;
}

const char *board_session(const char *text) {
    board_shown();
    board_type(text, strlen(text));
    while (basic_prompt()) {
    }
    return board_shown();
}

const char *board_answer(const char *line) {
    static char text[2000];
    char typed[900];
    snprintf(typed, sizeof typed, "%s\r", line);
    const char *shown = strstr(board_session(typed), "> ");
    snprintf(text, sizeof text, "%s", shown + strlen("> ") + strlen(line) + strlen("\r\n"));
    *strrchr(text, '>') = '\0';
    return text;
}

// ---- The board ----------------------------------------------------------------------------------

// When somebody types again; UINT64_MAX: never.
static uint64_t next_typing_us(void) {
    return state.later_first < state.later_count ? state.later[state.later_first].at_us
                                                 : UINT64_MAX;
}

static void type_what_is_due(void) {
    while (board.time_us >= next_typing_us()) {
        const char *text = state.later[state.later_first++].text;
        board_type(text, strlen(text));
    }
}

size_t hal_console_read(uint8_t *bytes, size_t size) {
    type_what_is_due();
    size_t count = state.typed - state.received;
    count = count < size ? count : size;
    memcpy(bytes, state.input + state.received, count);
    state.received += count;
    return count;
}

void hal_console_set_raw(bool raw) {
    (void)raw;
}

bool hal_console_break_is_inband(void) {
    return !board.piped;
}

size_t hal_console_write(const uint8_t *bytes, size_t size) {
    if (board.time_us < board.blocked_until_us) {
        return 0;
    }
    size_t room = SHOWN_SIZE - 1 - state.shown_length;
    size = size < room ? size : room;
    memcpy(state.shown + state.shown_length, bytes, size);
    state.shown_length += size;
    board.writes++;
    if (board.on_write != NULL) {
        board.on_write(bytes, size);
    }
    if (board.writes == board.hold_at_write) {
        board_type("\x06", 1);
    }
    return size;
}

bool hal_end_of_input(void) {
    return state.received == state.typed && next_typing_us() == UINT64_MAX;
}

uint64_t hal_time_us(void) {
    return board.time_us;
}

void hal_idle(uint64_t until_us) {
    uint64_t typing_us = next_typing_us();
    uint64_t next = typing_us < until_us ? typing_us : until_us;
    if (next != UINT64_MAX && next > board.time_us) {
        board.time_us = next;
    }
}

bool hal_statement(void) {
    board.statements++;
    board.time_us += 10;
    type_what_is_due();
    bool came = state.typed != state.told;
    state.told = state.typed;
    return came;
}

static jmp_buf restarted;

int board_restarts(void (*run)(void)) {
    volatile int how = setjmp(restarted);
    if (how == 0) {
        run();
    }
    return how;
}

void hal_restart(bool watchdog) {
    longjmp(restarted, 1 + watchdog);
}

void hal_bootloader(void) {
    longjmp(restarted, 3);
}

hal_start_t hal_start_reason(void) {
    return board.start_reason;
}

uint32_t hal_clock_hz(void) {
    return 125000000;
}

bool hal_tick_running(void) {
    return board.ticking;
}

const char *hal_firmware_version(void) {
    return "1.2.3-test";
}

const char *hal_board_name(void) {
    return "test board";
}

void hal_storage_read(uint32_t offset, void *bytes, size_t size) {
    memcpy(bytes, state.flash + offset, size);
}

const void *hal_storage_map(uint32_t offset) {
    return state.flash + offset;
}

bool hal_storage_is_writable(void) {
    return !board.ticking;
}

bool hal_storage_erase(uint32_t offset) {
    if (board.ticking) {
        return false;
    }
    memset(state.flash + offset, 0xFF, HAL_STORAGE_SECTOR);
    return true;
}

bool hal_storage_program(uint32_t offset, const void *page) {
    if (board.ticking || board.fail_program_after == 0) {
        return false;
    }
    board.fail_program_after -= board.fail_program_after > 0;
    for (size_t i = 0; i < HAL_STORAGE_PAGE; i++) {
        state.flash[offset + i] &= ((const uint8_t *)page)[i];
    }
    return true;
}
