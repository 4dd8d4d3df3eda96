// What the words of a line mean together. Inside gcode/ only. Context: main loop.
#ifndef GCODE_CHECK_H
#define GCODE_CHECK_H

#include "gcode/gcode_words.h"

#define GCODE_FEED_MIN 0.001 // per minute; slower than any machine
#define GCODE_FEED_MAX 1.0e9 // faster than the axes will allow
#define GCODE_BLEND_MAX_MM 1000.0

// Completes a line of which all words have been read: which code uses the axis words, lengths in
// mm, the modal state behind it. Errors: codes that do not go together, words that nothing uses or
// that are missing, values out of range.
err_t gcode_check(line_t *line, const gcode_state_t *before);

#endif
