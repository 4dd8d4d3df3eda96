// The face of the language: start, programs, the prompt. Context: main loop.
#include "basic/basic.h"

#include <stdarg.h>
#include <string.h>

#include "args.h"
#include "autosave.h"
#include "boot.h"
#include "channels.h"
#include "compiler.h"
#include "complete.h"
#include "console.h"
#include "editor.h"
#include "errors.h"
#include "events.h"
#include "files/files.h"
#include "hal/hal.h"
#include "help.h"
#include "line_editor.h"
#include "machine.h"
#include "memory.h"
#include "number_text.h"
#include "options.h"
#include "program.h"
#include "requests.h"
#include "symbols.h"
#include "transfer.h"
#include "vm.h"
#include "watchdog.h"
#include "words.h"

#define PRINT_SIZE 256
#define NOTICES_SIZE 256

static const basic_config_t *config;

// Notices that came while the console was busy, each with its line end.
static struct {
    char text[NOTICES_SIZE];
    size_t length;
} waiting;

// ---- Printing ------------------------------------------------------------------------------------

static void write_lines(const char *text) {
    for (; *text != '\0'; text++) {
        if (*text == '\n') {
            console_new_line();
        } else if (*text != '\r') {
            console_write(text, 1);
        }
    }
}

void basic_printf(const char *format, ...) {
    char text[PRINT_SIZE];
    va_list args;
    va_start(args, format);
    format_list(text, sizeof text, format, args);
    va_end(args);
    write_lines(text);
}

static void show_notice(const char *text) {
    if (editor_notice(text)) {
        return;
    }
    bool typing = line_editor_hide();
    if (!typing) {
        console_fresh_line();
    }
    write_lines(text);
    console_fresh_line();
    if (typing) {
        line_editor_show();
    }
}

static void keep_notice(const char *text) {
    size_t length = strlen(text);
    if (length + 1 < NOTICES_SIZE - waiting.length) {
        memcpy(waiting.text + waiting.length, text, length);
        waiting.length += length;
        waiting.text[waiting.length++] = '\n';
        waiting.text[waiting.length] = '\0';
    }
}

void basic_notice(const char *format, ...) {
    char text[PRINT_SIZE];
    va_list args;
    va_start(args, format);
    format_list(text, sizeof text, format, args);
    va_end(args);
    if (console_is_busy()) {
        keep_notice(text);
    } else {
        show_notice(text);
    }
}

static void show_waiting_notices(void) {
    if (waiting.length != 0 && !console_is_busy()) {
        char text[NOTICES_SIZE]; // while these are printed more may come
        memcpy(text, waiting.text, sizeof text);
        waiting.length = 0;
        show_notice(text);
    }
}

// It may come between an error and its message.
static void tend_files(void) {
    char before[ERR_MESSAGE_SIZE];
    strcpy(before, err_message());
    if (files_background() != ERR_OK) {
        basic_notice("Error : %s", err_message());
        err_raise(ERR_ARGUMENT, "%s", before);
    }
}

// Whenever the console waits and every few statements.
static void background(void) {
    show_waiting_notices();
    tend_files();
    watchdog_look();
    if (config->background != NULL) {
        config->background();
    }
}

char *basic_format_number(char *buffer, size_t size, double value) {
    char text[NUMBER_TEXT_SIZE];
    number_text_float(text, value);
    format_text(buffer, size, "%s", text);
    return buffer;
}

bool basic_break_pending(void) {
    console_poll();
    return console_break_pending();
}

static void print_error(const char *message) {
    console_fresh_line();
    size_t length;
    const char *line = vm_line() != 0 ? program_line(vm_line(), &length) : NULL;
    if (line != NULL) {
        editor_set_line(vm_line());
        char number[16];
        format_text(number, sizeof number, "[%u] ", vm_line());
        console_print(number);
        console_write(line, length);
        console_new_line();
    }
    console_print("Error : ");
    console_print(message);
    console_new_line();
}

static void nothing(void) {}

// ---- Running -------------------------------------------------------------------------------------

static void stop_machine(void) {
    if (config->on_break != NULL) {
        config->on_break();
    }
}

static void handle_break(void) {
    console_clear_break();
    console_fresh_line();
    stop_machine();
}

// Runs code to its end and reports what ended it.
static err_t run(const uint8_t *code, void (*on_error)(void)) {
    uint8_t *scratch = memory.scratch;
    bool broken;
    console_set_running(true);
    err_t error = vm_run(code, &broken);
    events_clear();
    watchdog_set(0);
    console_set_running(false);
    memory.scratch = scratch;
    if (broken || console_break_pending()) {
        handle_break();
    } else if (error != ERR_OK) {
        on_error();
        print_error(err_message());
    }
    return error;
}

static err_t report(err_t error) {
    if (error != ERR_OK) {
        vm.statement = NULL;
        print_error(err_message());
    }
    return error;
}

// The program of the file that was named, if one was.
static err_t load_requested(void) {
    return *requests_file() != '\0' ? report(program_load(requests_file())) : ERR_OK;
}

static struct {
    const char *text;
    size_t length;
    const uint8_t *code;
} line;

static void compile_line(void) {
    line.code = compiler_line(line.text, line.length);
}

static void (*on_program_error(void))(void) {
    return config->on_error != NULL ? config->on_error : nothing;
}

static bool has_routine(const char *name) {
    const symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, name, strlen(name));
    return symbol != NULL && !symbol->routine->is_function;
}

// Runs a SUB of the program, if it has one of this name.
static err_t run_routine(const char *name, void (*on_error)(void)) {
    if (!has_routine(name)) {
        return ERR_OK;
    }
    uint8_t *scratch = memory.scratch;
    err_t error = ERR_NO_MEMORY;
    vm.statement = NULL;
    line.text = name;
    line.length = strlen(name);
    if (errors_try(compile_line) == ERRORS_NONE) {
        error = run(line.code, on_error);
    } else {
        print_error(err_message());
    }
    memory.scratch = scratch;
    return error;
}

static err_t run_program(void) {
    void (*on_error)(void) = on_program_error();
    for (;;) {                          // a program may say RUN
        report(channels_end_program()); // those the prompt has opened
        size_t length;
        const char *argument = requests_argument(&length);
        err_t error = program_compile(argument, length);
        if (error != ERR_OK || program_code() == NULL) {
            return report(error);
        }
        error = run(program_code(), on_error);
        if (error == ERR_OK && vm.at_end) {
            error = run_routine("MM.END", on_error); // it has the last word
        }
        err_t closing = report(channels_end_program());
        error = error != ERR_OK ? error : closing;
        if (vm.request != VM_REQUEST_RUN || error != ERR_OK) {
            return error;
        }
        error = load_requested();
        if (error != ERR_OK) {
            return error;
        }
    }
}

// With a new program the channels of the old one are gone as its variables are.
static void end_if_new(err_t error) {
    report(error);
    if (error == ERR_OK) {
        report(channels_end_program());
    }
}

// What the line left to be done once it does not run any more.
static void serve(vm_request_t request) {
    switch (request) {
    case VM_REQUEST_RUN:
        if (load_requested() != ERR_OK) {
            break;
        }
        if (program_length() == 0) {
            report(err_raise(ERR_NO_PROGRAM, "%s", ""));
        }
        run_program();
        break;
    case VM_REQUEST_LOAD:
        load_requested();
        break;
    case VM_REQUEST_NEW:
        end_if_new(program_set_text("", 0));
        break;
    case VM_REQUEST_RECEIVE:
        end_if_new(transfer_receive_program());
        break;
    case VM_REQUEST_AUTOSAVE:
    case VM_REQUEST_APPEND: {
        bool start = false;
        err_t error = autosave_read(request == VM_REQUEST_APPEND, &start);
        report(error);
        report(program_compile_stored());
        if (start && error == ERR_OK) {
            run_program();
        }
        break;
    }
    case VM_REQUEST_EDIT: {
        bool start = false;
        const char *file = *requests_file() != '\0' ? requests_file() : NULL;
        err_t error = editor_edit(file, stop_machine, &start);
        if (error == ERR_OK && start && file != NULL) {
            error = program_load(file);
        }
        report(error != ERR_OK || start ? error : program_compile_stored());
        if (start && error == ERR_OK) {
            run_program();
        }
        break;
    }
    default:
        break;
    }
}

static void execute_line(void) {
    uint8_t *scratch = memory.scratch;
    vm.statement = NULL;
    requests_clear();
    if (errors_try(compile_line) != ERRORS_NONE) {
        print_error(err_message());
    } else {
        run(line.code, nothing);
    }
    memory.scratch = scratch;
    vm_request_t request = vm.request;
    vm.request = VM_REQUEST_NONE;
    serve(request);
}

// ---- Face ----------------------------------------------------------------------------------------

void basic_start(const basic_config_t *new_config) {
    config = new_config;
    vm.on_clear = config->on_clear != NULL ? config->on_clear : nothing;
    waiting.length = 0;
    console_start(background, config->on_control);
    line_editor_start();
    args_start(config);
    channels_start(config);
    complete_start(config);
    help_start(config);
    machine_start(config->may_restart);
    words_start(config);
    memory_start(config->arena, config->arena_size);
    program_use_text("", 0);
    if (config->banner != NULL) {
        console_print(config->banner);
    }
    report(files_start());
    options_start(config);
    report(program_start());
    console_flush();
}

void basic_boot(void) {
    bool autorun = options_get(OPTIONS_AUTORUN) != 0 && program_code() != NULL;
    if (!autorun && !has_routine("MM.STARTUP")) {
        return;
    }
    if (!boot_is_wanted()) {
        console_print("MM.STARTUP and AUTORUN are skipped\r\n");
        console_flush();
        return;
    }
    vm.request = VM_REQUEST_NONE;
    requests_clear();
    err_t error = run_routine("MM.STARTUP", on_program_error());
    if (error == ERR_OK && vm.request == VM_REQUEST_NONE && autorun) {
        run_program();
    } else {
        serve(vm.request);
    }
    vm.request = VM_REQUEST_NONE;
    console_flush();
}

err_t basic_run_program(const char *source, size_t length) {
    err_t error = program_use_text(source, length);
    if (error != ERR_OK) {
        report(error);
    } else {
        error = run_program();
    }
    console_flush();
    return error;
}

// The program may have its own prompt.
static const char *start_prompt(void) {
    console_fresh_line();
    show_waiting_notices();
    if (console_lost_input()) {
        console_print("Warning: input that the program did not read was lost\r\n");
    }
    if (!has_routine("MM.PROMPT") || run_routine("MM.PROMPT", nothing) != ERR_OK) {
        return "> ";
    }
    requests_clear();
    vm.request = VM_REQUEST_NONE;
    return "";
}

bool basic_prompt(void) {
    const line_editor_options_t options = {.prompt = start_prompt(), .prompt_keys = true};
    line_editor_result_t end = line_editor_read(&options, &line.text, &line.length);
    switch (end) {
    case LINE_EDITOR_LINE:
    case LINE_EDITOR_FINISHED:
    case LINE_EDITOR_FINISHED_RUN:
        execute_line();
        break;
    case LINE_EDITOR_TOO_LONG:
        vm.statement = NULL;
        err_raise(ERR_LINE_TOO_LONG, "%s", "");
        print_error(err_message());
        break;
    case LINE_EDITOR_BREAK:
        handle_break();
        break;
    case LINE_EDITOR_END:
        break;
    }
    console_flush();
    return end != LINE_EDITOR_END;
}
