// What the console tells the user besides the output of programs: answers of commands, notices,
// errors. Context: main loop.
#include "messages.h"

#include <stdarg.h>
#include <string.h>

#include "basic/basic.h"
#include "console.h"
#include "editor.h"
#include "line_editor.h"
#include "program.h"
#include "vm.h"

#define PRINT_SIZE 256
#define NOTICES_SIZE 256

// Notices that came while the console was busy, each with its line end.
static struct {
    char text[NOTICES_SIZE];
    size_t length;
} waiting;

void messages_start(void) {
    waiting.length = 0;
}

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

void messages_show_notices(void) {
    if (waiting.length != 0 && !console_is_busy()) {
        char text[NOTICES_SIZE]; // while these are printed more may come
        memcpy(text, waiting.text, sizeof text);
        waiting.length = 0;
        show_notice(text);
    }
}

void messages_error(void) {
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
    console_print(err_message());
    console_new_line();
}

err_t messages_report(err_t error) {
    if (error != ERR_OK) {
        vm.statement = NULL;
        messages_error();
    }
    return error;
}
