// G-code text to words. Inside gcode/ only. Context: main loop.
#ifndef GCODE_LEXER_H
#define GCODE_LEXER_H

#include "gcode/gcode.h"

// Takes `text` apart into at most GCODE_WORDS_MAX words. Blanks, tabs and commas may stand anywhere
// between letter and number as well as between words. Errors name the place.
err_t gcode_lexer_split(const char *text, size_t length, gcode_word_t *words, size_t *count);

#endif
