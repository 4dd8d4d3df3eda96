// Each command is a BASIC program of one line. Context: main loop.
#include "commands.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "basic/basic.h"
#include "basic_cmds/basic_cmds.h"
#include "host_console.h"
#include "model.h"

uint64_t commands_count;

static size_t send_nothing(uint8_t *bytes, size_t size) {
    (void)bytes;
    (void)size;
    return 0;
}

static bool never_at_end(void) {
    return false;
}

static void swallow(const uint8_t *bytes, size_t size) {
    (void)bytes;
    (void)size;
}

err_t command(const char *format, ...) {
    char line[160];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    commands_count++;
    return basic_run_program(line, strlen(line));
}

void must(const char *line) {
    if (command("%s", line) != ERR_OK) {
        fail("%s: %s", line, err_message());
    }
}

bool refused_for(err_t code) {
    static const char *const texts[ERR_COUNT] = {
#define ERR(name, text) [ERR_##name] = (text),
#include "base/err.def"
#undef ERR
    };
    return strcmp(err_message(), texts[code]) == 0;
}

void commands_start(void) {
    static uint8_t arena[32768] __attribute__((aligned(8)));
    static const host_console_peer_t peer = {send_nothing, never_at_end, swallow};
    static basic_config_t config = {
        .arena = arena,
        .arena_size = sizeof arena,
        .background = basic_cmds_background,
        .on_break = basic_cmds_break,
    };
    config.tables = basic_cmds_tables;
    config.table_count = basic_cmds_table_count;
    host_console_attach(&peer);
    basic_start(&config);
}
