// TRACE: the lines a program came through, shown as it runs or afterwards. Context: main loop.
#ifndef BASIC_TRACE_H
#define BASIC_TRACE_H

#include <stdbool.h>
#include <stdint.h>

#define TRACE_LINES 32u // remembered; a power of two

typedef struct {
    uint16_t last; // line of the statement that runs
    bool on;
    uint8_t next;                // free-running
    uint16_t lines[TRACE_LINES]; // 0: typed at the prompt
} trace_t;

extern trace_t trace;

// Shows that a line is reached.
void trace_print(unsigned line);

// Shows each line as it is reached, or no more.
void trace_show(bool on);

// Lists the last `count` lines, at most TRACE_LINES.
void trace_list(unsigned count);

// A program starts: the lines of the one before are forgotten.
void trace_clear(void);

// At each statement; a handful of instructions.
static inline void trace_statement(unsigned line) {
    if (line != trace.last) {
        trace.last = (uint16_t)line;
        trace.lines[trace.next++ % TRACE_LINES] = (uint16_t)line;
        if (trace.on) {
            trace_print(line);
        }
    }
}

#endif
