// The lines of a G-code file of A:. Context: main loop.
#include "gcode/gcode_file.h"

#include <string.h>

#include "files/files.h"

err_t gcode_file_open(gcode_file_t *file, const char *name, size_t length) {
    char path[FILES_PATH_MAX + 3]; // with its drive
    if (length >= sizeof path || memchr(name, '\0', length) != NULL) {
        return err_raise(ERR_FILE_BAD_NAME, "%.*s", (int)length, name);
    }
    memcpy(path, name, length);
    path[length] = '\0';
    int handle;
    err_t err = files_open(path, FILES_READ, &handle);
    if (err == ERR_OK) {
        memset(file, 0, sizeof *file);
        file->handle = handle;
        file->size = files_size(handle);
    }
    return err;
}

// Makes room behind what is left of the bytes and fills it.
static err_t fill(gcode_file_t *file) {
    file->filled = (uint16_t)(file->filled - file->next);
    memmove(file->bytes, file->bytes + file->next, file->filled);
    file->next = 0;
    size_t got;
    err_t err = files_read(file->handle, file->bytes + file->filled,
                           sizeof file->bytes - file->filled, &got);
    file->filled = (uint16_t)(file->filled + got);
    return err;
}

// Where the line that begins at file->next ends; file->filled if that is not in the buffer.
static uint16_t find_end(const gcode_file_t *file) {
    uint16_t end = file->next;
    while (end < file->filled && file->bytes[end] != '\n' && file->bytes[end] != '\r') {
        end++;
    }
    return end;
}

// The line that ends at `end`, and what makes it end.
static void take_line(gcode_file_t *file, uint16_t end) {
    file->begin = file->next;
    file->end = end;
    file->line++;
    bool pair = end + 1 < file->filled && file->bytes[end] == '\r' && file->bytes[end + 1] == '\n';
    file->next = (uint16_t)(end < file->filled ? end + 1 + pair : end);
}

// *more: there was a line.
static err_t read_line(gcode_file_t *file, bool *more) {
    *more = false;
    uint16_t end = find_end(file);
    // A \r at the very end is looked at together with what follows it.
    if (end + 1 >= file->filled) {
        err_t err = fill(file);
        if (err != ERR_OK) {
            return err;
        }
        end = find_end(file);
    }
    if ((unsigned)(end - file->next) > GCODE_FILE_LINE_MAX) {
        file->line++;
        return err_raise(ERR_LINE_TOO_LONG, NULL);
    }
    *more = file->next < file->filled;
    if (*more) {
        take_line(file, end);
    }
    return ERR_OK;
}

static char first_of(const gcode_file_t *file) {
    uint16_t at = file->begin;
    while (at < file->end && (file->bytes[at] == ' ' || file->bytes[at] == '\t')) {
        at++;
    }
    return at < file->end ? file->bytes[at] : '\0';
}

err_t gcode_file_next(gcode_file_t *file, bool *more) {
    for (;;) {
        err_t err = read_line(file, more);
        if (err != ERR_OK || !*more) {
            return err;
        }
        char first = first_of(file);
        bool begun = file->begun;
        file->begun = begun || first != '\0';
        if (first != '%') {
            return ERR_OK;
        }
        if (begun) {
            *more = false;
            return ERR_OK;
        }
    }
}

uint32_t gcode_file_position(const gcode_file_t *file) {
    return files_position(file->handle) - (uint32_t)(file->filled - file->next);
}

void gcode_file_close(gcode_file_t *file) {
    files_close(file->handle);
}
