// One line from the terminal, with the usual keys: left, right (with Ctrl by words), Home, End,
// Ins, Del, Backspace, Ctrl-U for the whole line, up and down through the history, Tab. Context:
// main loop.
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
    bool prompt_keys;   // Tab completes, up and down recall lines, function keys stand for lines
    bool finish_keys;   // F1 and F2 end all input, as Ctrl-Z does
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
