// The program in memory. Context: main loop.
#include "program.h"

#include <string.h>

#include "compiler.h"
#include "errors.h"
#include "memory.h"
#include "vm.h"

#define FREE_AFTER_TEXT                                                                            \
    (2048u + MEMORY_PROMPT_RESERVE) // room a program needs besides its text, at the very least

static struct {
    size_t length;
    const uint8_t *code; // NULL: empty
} program;

const char *program_text(void) {
    return (const char *)memory.floor;
}

size_t program_length(void) {
    return program.length;
}

static void compile(void) {
    vm_reset();
    memory_reset(memory.floor + program.length);
    program.code = compiler_program(program_text(), program.length);
    memory_settle();
}

static err_t try_compile(void) {
    program.code = NULL;
    if (errors_try(compile) == ERRORS_NONE) {
        return ERR_OK;
    }
    return ERR_PROGRAM_TOO_LONG;
}

void program_clear(void) {
    program.length = 0;
    try_compile();
}

err_t program_set(const char *text, size_t length) {
    if (length + FREE_AFTER_TEXT > (size_t)(memory.top - memory.floor)) {
        program_clear();
        return err_raise(ERR_PROGRAM_TOO_LONG, "%s", "");
    }
    char *to = (char *)memory.floor;
    memmove(to, text, length);
    size_t used = 0;
    for (size_t i = 0; i < length; i++) { // \r\n and \r become \n
        bool pair = to[i] == '\r' && i + 1 < length && to[i + 1] == '\n';
        if (!pair) {
            to[used++] = to[i] == '\r' ? '\n' : to[i];
        }
    }
    program.length = used;
    err_t error = try_compile();
    if (error != ERR_OK) {
        char message[ERR_MESSAGE_SIZE];
        strcpy(message, err_message());
        program_clear();
        err_raise(ERR_ARGUMENT, "%s", message);
    }
    return error;
}

const uint8_t *program_prepare(void) {
    try_compile();
    return program.length != 0 ? program.code : NULL;
}

const char *program_line(unsigned number, size_t *length) {
    const char *text = program_text();
    const char *end = text + program.length;
    for (unsigned line = 1; text < end; line++) {
        const char *stop = memchr(text, '\n', (size_t)(end - text));
        stop = stop != NULL ? stop : end;
        if (line == number) {
            *length = (size_t)(stop - text);
            return text;
        }
        text = stop + 1;
    }
    return NULL;
}
