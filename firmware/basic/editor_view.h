// What the editor shows: a window on the text, a line that says where one is, and a line for keys,
// messages and questions. Context: main loop.
#ifndef BASIC_EDITOR_VIEW_H
#define BASIC_EDITOR_VIEW_H

#include <stdbool.h>
#include <stddef.h>

// `name` (NULL: the program) stays valid.
void editor_view_start(const char *name, bool coloured);

// Rows of text on the screen.
unsigned editor_view_rows(void);

// Draws what has changed.
void editor_view_draw(void);

// Shown instead of the keys until editor_view_clear_message(); cut to the width.
void editor_view_message(const char *format, ...) __attribute__((format(printf, 1, 2)));
void editor_view_clear_message(void);

// Draws a question and what has been answered, with the cursor behind it.
void editor_view_ask(const char *question, const char *answer);

#endif
