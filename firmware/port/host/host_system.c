// Brings the simulated board up and takes it down again. Context: main.
#include "host_system.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "hal/hal.h"
#include "host_console.h"
#include "host_idle.h"
#include "host_inputs.h"
#include "host_machine.h"
#include "host_options.h"
#include "host_report.h"
#include "host_signals.h"
#include "host_storage.h"
#include "host_terminal.h"
#include "host_trace.h"
#include "version.h"

// Of the size that a Raspberry Pi Pico has to offer: what does not fit there shall not fit here.
#define MEMORY_SIZE (112u * 1024u)

#define EXIT_RESTART 4
#define EXIT_WATCHDOG 5

void hal_init(int argc, char **argv) {
    const host_options_t *options = host_options_parse(argc, argv);
    if (options->flash_path != NULL) {
        host_storage_open(options->flash_path);
    }
    host_storage_cut(options->flash_cut, options->flash_cut_kind);
    if (options->inputs_path != NULL) {
        host_inputs_load(options->inputs_path);
    }
    if (options->machine_path != NULL) {
        host_machine_load(options->machine_path);
    }
    if (options->report_path != NULL) {
        host_report_open(options->report_path);
    }
    if (options->trace_path != NULL) {
        host_trace_open(options->trace_path);
    }
    host_signals_init();
    // Run at every orderly exit, the last one first: the edges are safe before anything can be kept
    // waiting, by a reader who is slow.
    atexit(host_terminal_restore);
    atexit(host_console_finish);
    atexit(host_report_close);
    atexit(host_trace_close);
    host_terminal_raw();
    host_idle_init(options->realtime);
    host_inputs_apply(0);
}

void hal_exit(int code) {
    exit(code);
}

void hal_restart(bool watchdog) {
    exit(watchdog ? EXIT_WATCHDOG : EXIT_RESTART);
}

void hal_bootloader(void) {
    exit(EXIT_RESTART);
}

hal_start_t hal_start_reason(void) {
    return HAL_START_POWER;
}

void *hal_memory(size_t *size) {
    static _Alignas(8) uint8_t memory[MEMORY_SIZE];
    *size = sizeof memory;
    return memory;
}

const char *hal_board_name(void) {
    return "host";
}

const char *hal_firmware_version(void) {
    return STEPMITE_VERSION;
}

void host_system_fail(const char *format, ...) {
    va_list args;
    va_start(args, format);
    fputs("stepmite: ", stderr);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    exit(HOST_SYSTEM_EXIT_USAGE);
}
