// Settings that outlive power-off, in a file of A:, replaced as a whole. Those of the product are
// there under the names it gives them (basic_option() in basic.h). Context: main loop.
#ifndef BASIC_OPTIONS_H
#define BASIC_OPTIONS_H

#include "basic/basic.h"

// The language's own; rows of a table in options.c.
typedef enum {
    OPTIONS_AUTORUN,      // 1: the program is run at power-up
    OPTIONS_BREAK,        // code of the key that ends a program; 0: none does
    OPTIONS_COLOUR,       // 1: EDIT shows colours
    OPTIONS_CONTINUATION, // 1: an underscore at the end of a line joins it with the next
    OPTIONS_DISPLAY,      // lines * 256 + columns of the terminal
    OPTIONS_TAB,          // columns between the stops of the Tab key
    OPTIONS_COUNT
} options_t;

#define OPTIONS_DISPLAY_VALUE(lines, columns) ((int64_t)(lines) * 256 + (columns))

// Reads the file and lets the settings take effect: at the start, and when the file is another one
// or gone.
void options_start(void);

int64_t options_get(options_t option);

// Keeps a setting, and lets it take effect. Errors: as files_replace(); nothing has changed then.
err_t options_set(options_t option, int64_t value);

// Back to what all settings are at first.
err_t options_reset(void);

// Prints those that are kept, as the statements that set them.
void options_list(void);

#endif
