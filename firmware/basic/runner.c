// Runs lines of the prompt and the program, and then does what they have asked for. Context: main
// loop.
#include "runner.h"

#include <string.h>

#include "autosave.h"
#include "channels.h"
#include "compiler.h"
#include "console.h"
#include "editor.h"
#include "errors.h"
#include "events.h"
#include "files/files.h"
#include "memory.h"
#include "messages.h"
#include "program.h"
#include "requests.h"
#include "symbols.h"
#include "transfer.h"
#include "vm.h"
#include "watchdog.h"

static struct {
    void (*on_break)(void);
    void (*on_error)(void);
    void (*on_new)(void);
    bool was_broken;
} runner;

// The line at hand.
static struct {
    const char *text;
    size_t length;
    const uint8_t *code;
} line;

static void nothing(void) {}

void runner_start(const basic_config_t *config) {
    runner.on_break = config->on_break != NULL ? config->on_break : nothing;
    runner.on_error = config->on_error != NULL ? config->on_error : nothing;
    runner.on_new = config->on_new != NULL ? config->on_new : nothing;
}

void runner_break(void) {
    console_clear_break();
    console_fresh_line();
    runner.on_break();
}

bool runner_was_broken(void) {
    return runner.was_broken;
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
    runner.was_broken = broken || console_break_pending();
    if (runner.was_broken) {
        runner_break();
    } else if (error != ERR_OK) {
        on_error();
        messages_error();
    }
    return error;
}

// The program of the file that was named, if one was.
static err_t load_requested(void) {
    return *requests_file() != '\0' ? messages_report(program_load(requests_file())) : ERR_OK;
}

// The same for RUN, in front of which the product starts anew, if there is something to run.
static err_t load_to_run(void) {
    files_entry_t entry;
    if (*requests_file() != '\0') {
        err_t error = files_info(requests_file(), &entry);
        if (error != ERR_OK) {
            return messages_report(error);
        }
    } else if (program_length() == 0) {
        return ERR_OK;
    }
    runner.on_new();
    return load_requested();
}

static void compile_line(void) {
    line.code = compiler_line(line.text, line.length);
}

static bool compile(const char *text, size_t length) {
    vm.statement = NULL;
    line.text = text;
    line.length = length;
    if (errors_try(compile_line) != ERRORS_NONE) {
        messages_error();
        return false;
    }
    return true;
}

bool runner_has_routine(const char *name) {
    const symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, name, strlen(name));
    return symbol != NULL && !symbol->routine->is_function;
}

// Runs a SUB of the program, if it has one of this name.
static err_t run_routine(const char *name, void (*on_error)(void)) {
    if (!runner_has_routine(name)) {
        return ERR_OK;
    }
    uint8_t *scratch = memory.scratch;
    err_t error = ERR_NO_MEMORY;
    if (compile(name, strlen(name))) {
        error = run(line.code, on_error);
    }
    memory.scratch = scratch;
    return error;
}

err_t runner_routine(const char *name) {
    return run_routine(name, runner.on_error);
}

err_t runner_prompt_routine(const char *name) {
    return run_routine(name, nothing);
}

err_t runner_program(void) {
    for (;;) {                                   // a program may say RUN
        messages_report(channels_end_program()); // those the prompt has opened
        size_t length;
        const char *argument = requests_argument(&length);
        err_t error = program_compile(argument, length);
        if (error != ERR_OK || program_code() == NULL) {
            return messages_report(error);
        }
        error = run(program_code(), runner.on_error);
        if (error == ERR_OK && vm.at_end) {
            error = runner_routine("MM.END"); // it has the last word
        }
        err_t closing = messages_report(channels_end_program());
        error = error != ERR_OK ? error : closing;
        if (vm.request != VM_REQUEST_RUN || error != ERR_OK) {
            return error;
        }
        error = load_to_run();
        if (error != ERR_OK) {
            return error;
        }
    }
}

static void run_new(void) {
    runner.on_new();
    runner_program();
}

// With a new program the channels of the old one are gone as its variables are.
static void end_if_new(err_t error) {
    messages_report(error);
    if (error == ERR_OK) {
        messages_report(channels_end_program());
    }
}

void runner_serve(void) {
    vm_request_t request = vm.request;
    vm.request = VM_REQUEST_NONE;
    switch (request) {
    case VM_REQUEST_RUN:
        if (load_to_run() != ERR_OK) {
            break;
        }
        if (program_length() == 0) {
            messages_report(err_raise(ERR_NO_PROGRAM, "%s", ""));
        }
        runner_program();
        break;
    case VM_REQUEST_LOAD:
        load_requested();
        break;
    case VM_REQUEST_NEW:
        runner.on_new();
        end_if_new(program_set_text("", 0));
        break;
    case VM_REQUEST_RECEIVE:
        end_if_new(transfer_receive_program());
        break;
    case VM_REQUEST_AUTOSAVE:
    case VM_REQUEST_APPEND: {
        bool start = false;
        err_t error = autosave_read(request == VM_REQUEST_APPEND, &start);
        messages_report(error);
        messages_report(program_compile_stored());
        if (start && error == ERR_OK) {
            run_new();
        }
        break;
    }
    case VM_REQUEST_EDIT: {
        bool start = false;
        const char *file = *requests_file() != '\0' ? requests_file() : NULL;
        err_t error = editor_edit(file, runner.on_break, &start);
        if (error == ERR_OK && start && file != NULL) {
            error = program_load(file);
        }
        messages_report(error != ERR_OK || start ? error : program_compile_stored());
        if (start && error == ERR_OK) {
            run_new();
        }
        break;
    }
    default:
        break;
    }
}

void runner_line(const char *text, size_t length) {
    uint8_t *scratch = memory.scratch;
    requests_clear();
    if (compile(text, length)) {
        run(line.code, nothing);
    }
    memory.scratch = scratch;
    runner_serve();
}
