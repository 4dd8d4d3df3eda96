// One line from the terminal, with the keys of a VT100: left, right, Home, End, Ins, Del, Backspace,
// up and down through the history, Ctrl-U. Context: main loop.
#ifndef BASIC_LINE_EDITOR_H
#define BASIC_LINE_EDITOR_H

#include <stdbool.h>
#include <stddef.h>

#define LINE_EDITOR_MAX 255

typedef enum {
    LINE_EDITOR_LINE,         // a line is complete
    LINE_EDITOR_TOO_LONG,     // a line was longer than LINE_EDITOR_MAX; all of it is dropped
    LINE_EDITOR_BREAK,        // Ctrl-C
    LINE_EDITOR_FINISHED,     // Ctrl-Z or F1; what was typed on the line counts
    LINE_EDITOR_FINISHED_RUN, // F2; likewise
    LINE_EDITOR_END,          // no more input can come
} line_editor_result_t;

typedef struct {
    const char *prompt; // drawn before the line
    bool history;       // up and down recall lines, and this line is remembered
    bool keep_tabs;     // a tab is text, not a key
} line_editor_options_t;

// Forgets the history.
void line_editor_start(void);

// Draws the prompt and reads a line to *line (zero-terminated, valid until the next call).
// Echoes it and ends it with "\r\n".
line_editor_result_t line_editor_read(const line_editor_options_t *options, const char **line,
                                      size_t *length);

// Takes the line being typed off the screen and, after other text was printed, draws it again.
// Nothing while no line is being typed; then the first returns false.
bool line_editor_hide(void);
void line_editor_show(void);

#endif
