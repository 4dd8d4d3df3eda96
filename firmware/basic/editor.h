// EDIT: the full-screen editor. Context: main loop.
#ifndef BASIC_EDITOR_H
#define BASIC_EDITOR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/base.h"

// Edits the program, or a file if `file` is not NULL (valid meanwhile). *start
// becomes true if the program is to run. Until it returns Ctrl-C and other control characters are
// keys of the editor. `on_break` is what Ctrl-C does at the prompt. Errors: not enough memory, the
// file cannot be read.
err_t editor_edit(const char *file, void (*on_break)(void), bool *start);

// The next EDIT of the program starts at this line (from 1): where an error was.
void editor_set_line(unsigned line);

// Shows a line from outside in the editor. False: no editor is on the screen.
bool editor_notice(const char *text);

#endif
