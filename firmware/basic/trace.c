// The lines a program came through. Context: main loop.
#include "trace.h"

#include <string.h>

#include "base/base.h"
#include "console.h"

trace_t trace;

void trace_print(unsigned line) {
    if (line != 0) {
        char text[16];
        console_write(text, format_text(text, sizeof text, "[%u]", line));
    }
}

void trace_show(bool on) {
    trace.on = on;
}

void trace_list(unsigned count) {
    count = count < TRACE_LINES ? count : TRACE_LINES;
    for (unsigned back = count; back > 0; back--) {
        trace_print(trace.lines[(trace.next - back) % TRACE_LINES]);
    }
    console_new_line();
}

void trace_clear(void) {
    memset(trace.lines, 0, sizeof trace.lines);
    trace.last = 0;
}
