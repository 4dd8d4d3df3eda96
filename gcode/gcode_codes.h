// The table of G and M codes. Inside gcode/ only. Context: main loop.
#ifndef GCODE_CODES_H
#define GCODE_CODES_H

#include "gcode/gcode_words.h"

// Takes a word G or M into the line. Errors: no such code, a second word of its modal group.
err_t gcode_codes_read(line_t *line, char letter, double value);

#endif
