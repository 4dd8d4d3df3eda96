// The lines of a G-code file of A:, one after the other. Inside gcode/ only. Context: main loop.
#ifndef GCODE_FILE_H
#define GCODE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

// As long as a string of the language, so that a file may hold what STEPPER GS takes.
#define GCODE_FILE_LINE_MAX 255u

// An open file with the line that is read; belongs to the caller.
typedef struct {
    int handle;
    uint32_t size;                       // bytes
    uint32_t line;                       // number of the line, from 1; 0 before the first
    bool begun;                          // a line with something in it was read
    uint16_t begin;                      // of the line in `bytes`
    uint16_t end;                        // of the line
    uint16_t next;                       // where the line behind it begins
    uint16_t filled;                     // bytes that were read
    char bytes[GCODE_FILE_LINE_MAX + 2]; // a line and its \r\n
} gcode_file_t;

// Errors: the name is too long, those of files_open().
err_t gcode_file_open(gcode_file_t *file, const char *name, size_t length);

// Goes to the next line, which ends with \n, \r or both, or with the file. *more: there is one. A
// line that begins with % is none; it also ends the program, unless it is the first one with
// something in it. Errors: of reading; the line is too long.
err_t gcode_file_next(gcode_file_t *file, bool *more);

static inline const char *gcode_file_text(const gcode_file_t *file) {
    return file->bytes + file->begin;
}

static inline size_t gcode_file_length(const gcode_file_t *file) {
    return (size_t)(file->end - file->begin);
}

// Bytes up to the end of the line, its end included.
uint32_t gcode_file_position(const gcode_file_t *file);

void gcode_file_close(gcode_file_t *file);

#endif
