// G-code text to words. Inside gcode/ only. Context: main loop.
#ifndef GCODE_LEXER_H
#define GCODE_LEXER_H

#include "gcode/gcode.h"

typedef struct {
    gcode_word_t *words; // GCODE_WORDS_MAX of them, the caller's
    size_t count;
    const char *message; // of the last (MSG,...) comment, within the text
    size_t message_length;
} gcode_lexed_t;

// Takes `text` apart. Blanks, tabs and commas may stand anywhere between letter and number as well
// as between words. A line that begins with % is empty; so is one that begins with / if
// `options->block_delete`, else the / is skipped. Behind a code that homes, an axis may stand
// without a number, which is 0 then: `G28 X`. Errors name the place.
err_t gcode_lexer_split(const char *text, size_t length, const gcode_options_t *options,
                        gcode_lexed_t *lexed);

#endif
