// G-code: from a line of text to one entry of the motion queue. The face of gcode/. G0 G1 G2 G3 G4
// G17 G18 G19 G61 G61.1 G64 G90 G91 G91.1 G92 M3 M5; words X Y Z A I J K R F P; comments ( ), ; and
// BASIC's '. Modal: motion, plane, path mode, distance mode and F stay in force. Context: main
// loop.
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
// nothing, modal state included: the same line may be sent again. Errors: of the text (which word),
// of the combination of words, and those of stepper_move() and others.
err_t gcode_line(const char *text, size_t length);

// The same for words that are already apart.
err_t gcode_words(const gcode_word_t *words, size_t count);

// G90, G17, G64, no motion mode, no feed; no work offsets; A words of arcs count.
void gcode_reset(void);
// Only the first five; the work offsets stay.
void gcode_reset_modal(void);

// The plane of arcs: G17, G18, G19.
typedef enum { GCODE_PLANE_XY, GCODE_PLANE_ZX, GCODE_PLANE_YZ } gcode_plane_t;
gcode_plane_t gcode_plane(void);

// How corners are passed: G61 exact, G61.1 stop, G64 continuous, G64 P blend within P mm.
typedef struct {
    stepper_corner_t corner;
    double blend_mm; // of a blend, > 0
} gcode_path_t;
gcode_path_t gcode_path(void);

// Whether A words in lines with an arc are ignored instead of turning A along.
void gcode_set_arc_legacy(bool legacy);
bool gcode_arc_legacy(void);

// Work position = machine position - offset; set by G92, in mm or degrees.
double gcode_offset(axis_id_t axis);
void gcode_clear_offsets(void);

#endif
