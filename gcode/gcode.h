// G-code: from a line of text to one entry of the motion queue. The face of gcode/.
// G0 G1 G4 G90 G91 G92 M3 M5; words X Y Z A F P; comments ( ), ; and BASIC's '. Modal: motion, distance
// mode and F stay in force. Context: main loop.
#ifndef GCODE_H
#define GCODE_H

#include <stddef.h>

#include "base/base.h"
#include "stepper/stepper.h"

// A letter and its number, letter in capitals.
typedef struct {
    char letter;
    double value;
} gcode_word_t;

#define GCODE_WORDS_MAX 32

// Carries out a line. An empty line and one of comments only is fine. A refused line has changed
// nothing, modal state included: the same line may be sent again.
// Errors: of the text (which word), of the combination of words, and those of stepper_move() and others.
err_t gcode_line(const char *text, size_t length);

// The same for words that are already apart.
err_t gcode_words(const gcode_word_t *words, size_t count);

// G90, no motion mode, no feed, no work offsets.
void gcode_reset(void);
// G90, no motion mode, no feed; the work offsets stay.
void gcode_reset_modal(void);

// Work position = machine position - offset; set by G92, in mm or degrees.
double gcode_offset(axis_id_t axis);
void gcode_clear_offsets(void);

#endif
