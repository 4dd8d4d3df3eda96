// Cuts a program's text into the lines that are compiled: without block comments, and with the
// lines that a blank and an underscore at the end join, if OPTION CONTINUATION LINES is on.
// Context: main loop, while compiling.
#ifndef BASIC_SOURCE_LINES_H
#define BASIC_SOURCE_LINES_H

#include <stdbool.h>
#include <stddef.h>

#define SOURCE_LINES_MAX 255 // characters

typedef struct {
    const char *text,
        *end;        // joined lines still have their ends between them, which the lexer skips
    unsigned number; // of the first one, from 1
    bool too_long;   // one of them
} source_line_t;

// From the start of `text`.
void source_lines_start(const char *text, size_t length);

// The next line. False: there is none.
bool source_lines_next(source_line_t *line);

// Whether lines are joined where a program does not say it by OPTION CONTINUATION LINES.
void source_lines_join(bool on);

// True if an underscore at `p`, with blanks only behind it, ends its line.
bool source_lines_is_joint(const char *p, const char *end);

#endif
