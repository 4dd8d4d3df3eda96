// Which part of a line is a keyword, a string, a number, a comment. Context: main loop.
#ifndef BASIC_EDITOR_COLOUR_H
#define BASIC_EDITOR_COLOUR_H

#include <stddef.h>

#include "editor_screen.h"

typedef struct {
    size_t until; // `look` holds up to here
    editor_screen_look_t look;
} editor_colour_t;

// Begins a line that starts at `place`.
editor_colour_t editor_colour_line(size_t place);

// The look of the byte at `place`; places must come in rising order.
editor_screen_look_t editor_colour_at(editor_colour_t *colour, size_t place);

#endif
