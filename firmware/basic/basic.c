// The face of the language: start, power-up, the prompt. Context: main loop.
#include "basic/basic.h"

#include <string.h>

#include "actions.h"
#include "args.h"
#include "boot.h"
#include "channels.h"
#include "complete.h"
#include "console.h"
#include "files/files.h"
#include "help.h"
#include "line_editor.h"
#include "memory.h"
#include "messages.h"
#include "options.h"
#include "program.h"
#include "requests.h"
#include "rows.h"
#include "runner.h"
#include "vm.h"
#include "watchdog.h"
#include "words.h"

static const basic_config_t *config;

// It may come between an error and its message.
static __attribute__((noinline)) void tend_files(void) {
    err_kept_t kept;
    err_keep(&kept);
    if (files_background() != ERR_OK) {
        basic_notice("Error : %s", err_message());
    }
    err_put_back(&kept);
}

// Whenever the console waits and every few statements.
static void background(void) {
    messages_show_notices();
    if (files_background_waits()) {
        tend_files();
    }
    watchdog_look();
    if (config->background != NULL) {
        config->background();
    }
}

bool basic_break_pending(void) {
    console_poll();
    return console_break_pending();
}

bool basic_wait(uint64_t until_us) {
    console_wait(until_us);
    return !console_break_pending();
}

void *basic_scratch(size_t size) {
    return memory_free() > size + MEMORY_PROMPT_RESERVE ? memory_scratch(size) : NULL;
}

void basic_wake(void) {
    console_wake();
}

void basic_wake_at(uint64_t time_us) {
    console_wake_at(time_us);
}

static void nothing(void) {}

static void show_banner(void) {
    if (config->banner != NULL) {
        console_print(config->banner);
        basic_printf("\n%u bytes for programs and variables, HELP lists commands\n\n",
                     (unsigned)memory_free());
    }
}

void basic_start(const basic_config_t *new_config) {
    config = new_config;
    vm.on_clear = config->on_clear != NULL ? config->on_clear : nothing;
    messages_start();
    runner_start(config);
    console_start(background, config->on_control);
    line_editor_start();
    actions_start(config);
    rows_start(config);
    channels_start(config);
    words_start();
    memory_start(config->arena, config->arena_size);
    program_use_text("", 0);
    show_banner();
    messages_report(files_start());
    options_start();
    messages_report(program_start());
    console_flush();
}

void basic_boot(void) {
    bool autorun = options_get(OPTIONS_AUTORUN) != 0 && program_code() != NULL;
    if (!autorun && !runner_has_routine("MM.STARTUP")) {
        return;
    }
    if (!boot_is_wanted()) {
        console_print("MM.STARTUP and AUTORUN are skipped\r\n");
        console_flush();
        return;
    }
    vm.request = VM_REQUEST_NONE;
    requests_clear();
    bool has_startup = runner_has_routine("MM.STARTUP");
    err_t error = runner_routine("MM.STARTUP");
    if (has_startup && runner_was_broken()) {
        console_print(autorun ? "AUTORUN is skipped\r\n" : "");
    } else if (error == ERR_OK && vm.request == VM_REQUEST_NONE && autorun) {
        runner_program();
    } else {
        runner_serve();
    }
    vm.request = VM_REQUEST_NONE;
    console_flush();
}

err_t basic_run_program(const char *source, size_t length) {
    err_t error = program_use_text(source, length);
    if (error != ERR_OK) {
        messages_report(error);
    } else {
        error = runner_program();
    }
    console_flush();
    return error;
}

// The program may have its own prompt.
static const char *start_prompt(void) {
    console_fresh_line();
    messages_show_notices();
    if (console_lost_input()) {
        console_print("Warning: input that the program did not read was lost\r\n");
    }
    if (!runner_has_routine("MM.PROMPT") || runner_prompt_routine("MM.PROMPT") != ERR_OK ||
        runner_was_broken()) {
        return "> ";
    }
    requests_clear();
    vm.request = VM_REQUEST_NONE;
    return "";
}

bool basic_prompt(void) {
    const line_editor_options_t options = {.prompt = start_prompt(), .prompt_keys = true};
    const char *text;
    size_t length;
    line_editor_result_t end = line_editor_read(&options, &text, &length);
    switch (end) {
    case LINE_EDITOR_LINE:
    case LINE_EDITOR_FINISHED:
    case LINE_EDITOR_FINISHED_RUN:
        runner_line(text, length);
        break;
    case LINE_EDITOR_TOO_LONG:
        messages_report(err_raise(ERR_LINE_TOO_LONG, "%s", ""));
        break;
    case LINE_EDITOR_BREAK:
        runner_break();
        break;
    case LINE_EDITOR_END:
        break;
    }
    console_flush();
    return end != LINE_EDITOR_END;
}
