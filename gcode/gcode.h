// G-code: from a line of text to entries of the motion queue. The face of gcode/.
// docs/gcode.md lists the codes. A line is read whole and checked whole. A refused line has
// changed nothing, modal state included: the same line may be sent again. Context: main loop.
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

// Carries out a line. An empty line and one of comments only is fine. Errors: of the text (which
// word), of the combination of words, those of stepper_move() and others. A line that needs several
// entries is accepted when the first has found room; the others follow in gcode_background(), and
// until then the next line is refused with ERR_GCODE_BUFFER_FULL.
err_t gcode_line(const char *text, size_t length);

// The same for words that are already apart.
err_t gcode_words(const gcode_word_t *words, size_t count);

// Queues what waits for room, and notices the end of homing and probing; call it often.
void gcode_background(void);

// Entries of an accepted line wait for room, or its homing or probing is under way.
bool gcode_busy(void);

// The line homes or probes: who sent it may want to wait for the end, and then ask for its error.
bool gcode_must_wait(void);

// What became of an accepted line that could not be carried out to its end; told once. And whether
// there is something to tell.
err_t gcode_failure(void);
bool gcode_failed(void);

// What the pause that the machine came to last is for; to be asked once for each. False: for
// something else than M0, M1 or M6, or nobody knows.
#define GCODE_NO_TOOL UINT32_MAX
bool gcode_take_pause(uint32_t *tool); // the tool of M6, else GCODE_NO_TOOL

// True once after M2 or M30: the program has ended.
bool gcode_take_end(void);

// ---- State --------------------------------------------------------------------------------------

// After INIT: all modes as after power-up, options off, G92 cleared. Coordinate systems, tool
// lengths and stored places stay, and the tool length in force.
void gcode_reset(void);
// Motion mode, plane, distance, centre, path and feed mode, units and the feed as after power-up;
// what waits is dropped. Offsets, tool and spindle speed stay.
void gcode_reset_modal(void);

// What lines mean. All off after INIT.
typedef struct {
    bool nist;          // G4 P in seconds; G28 goes to a stored place
    bool arc_legacy;    // A words in lines with an arc are ignored instead of turning A along
    bool block_delete;  // lines that begin with / are skipped
    bool optional_stop; // M1 pauses
} gcode_options_t;
const gcode_options_t *gcode_options(void);
void gcode_set_options(const gcode_options_t *options);

// How corners are passed: G61 exact, G61.1 stop, G64 continuous, G64 P blend within P mm.
typedef struct {
    stepper_corner_t corner;
    double blend_mm; // of a blend, > 0
} gcode_path_t;
gcode_path_t gcode_path(void);

// Machine position = work position + offset, in mm or degrees: the coordinate system, G92 and, on
// Z, the tool's length.
double gcode_offset(axis_id_t axis);
double gcode_work_position(axis_id_t axis);
// As G92.1.
void gcode_clear_offsets(void);

// The modes in force as G-code: "G0 G54 G17 G21 G90 G94 ...". Returns the length of the text.
#define GCODE_MODES_SIZE 120
size_t gcode_modes(char *text);

// Who is told the text of (MSG,...) comments when they are read: `length` bytes. NULL: nobody.
void gcode_set_listener(void (*listener)(const char *text, size_t length));

#endif
