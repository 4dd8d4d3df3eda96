// The program at hand. Context: main loop.
#include "program.h"

#include <string.h>

#include "compiler.h"
#include "errors.h"
#include "files/files.h"
#include "memory.h"
#include "program_storage.h"
#include "value.h"
#include "vm.h"

static struct {
    const char *text;
    size_t length;
    const uint8_t *code; // NULL: empty, or it did not compile
    size_t code_size;
    bool stale;             // the text is newer than the code
    size_t argument_length; // its bytes lie where the arena's memory starts
} program = {.text = ""};

const char *program_text(void) {
    return program.text;
}

size_t program_length(void) {
    return program.length;
}

const uint8_t *program_code(void) {
    return program.code;
}

size_t program_code_size(void) {
    return program.code_size;
}

const char *program_argument(size_t *length) {
    *length = program.argument_length;
    return (const char *)memory.floor;
}

static void start_memory(void) {
    vm_reset();
    memory_reset(memory.floor + program.argument_length);
}

static void compile_all(void) {
    start_memory();
    program.code = compiler_program(program.text, program.length);
    memory_settle();
    program.code_size = (size_t)(memory.heap - memory.floor) - program.argument_length;
}

static void compile_nothing(void) {
    start_memory();
    compiler_program("", 0);
    memory_settle();
}

err_t program_compile(const char *argument, size_t length) {
    memmove(memory.floor, argument, length);
    program.argument_length = length;
    program.code = NULL;
    program.code_size = 0;
    program.stale = false;
    if (errors_try(compile_all) == ERRORS_NONE) {
        program.code = program.length != 0 ? program.code : NULL;
        return ERR_OK;
    }
    program.code = NULL;
    errors_try(compile_nothing);
    return err_raise(ERR_PROGRAM_MEMORY, NULL);
}

static bool find_stored(void) {
    bool damaged;
    program.text = program_storage_text(&program.length, &damaged);
    program.code = NULL;
    program.stale = true;
    return !damaged;
}

err_t program_start(void) {
    bool whole = find_stored();
    err_t error = program_compile("", 0);
    if (!whole) {
        return err_raise(program.length != 0 ? ERR_STORAGE_OLDER : ERR_STORAGE_CORRUPT, NULL);
    }
    return error;
}

static err_t commit(program_storage_t *writer) {
    err_t error = program_storage_commit(writer);
    if (error == ERR_OK) {
        find_stored();
    }
    return error;
}

err_t program_compile_stored(void) {
    return program.stale ? program_compile("", 0) : ERR_OK;
}

void program_release(void) {
    program.argument_length = 0;
    program.code = NULL;
    program.code_size = 0;
    program.stale = true;
    errors_try(compile_nothing);
}

err_t program_store_text(const char *text, size_t length) {
    program_storage_t writer;
    program_storage_begin(&writer);
    err_t error = program_storage_add(&writer, text, length);
    return error == ERR_OK ? commit(&writer) : error;
}

err_t program_set_text(const char *text, size_t length) {
    err_t error = program_store_text(text, length);
    return error == ERR_OK ? program_compile_stored() : error;
}

static err_t copy_file(int file, program_storage_t *writer) {
    char text[VALUE_STRING_MAX];
    size_t got;
    err_t error;
    do {
        error = files_read(file, text, sizeof text, &got);
        if (error == ERR_OK) {
            error = program_storage_add(writer, text, got);
        }
    } while (error == ERR_OK && got != 0);
    return error;
}

err_t program_load(const char *path) {
    int file;
    err_t error = files_open(path, FILES_READ, &file);
    if (error != ERR_OK) {
        return error;
    }
    program_storage_t writer;
    program_storage_begin(&writer);
    error = copy_file(file, &writer);
    files_close(file);
    if (error == ERR_OK) {
        error = commit(&writer);
    }
    return error == ERR_OK ? program_compile_stored() : error;
}

err_t program_use_text(const char *text, size_t length) {
    program.text = text;
    program.length = length;
    return program_compile("", 0);
}

const char *program_line(unsigned number, size_t *length) {
    const char *text = program.text;
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
