// Canned cycles: G73, G81, G82 and G83 as a sequence of moves and dwells. Inside gcode/ only.
// Context: main loop.
//
// gcode_cycle_begin() gets a line whose words have passed the checks of gcode_check.c: the motion
// is a cycle, all lengths are in mm and P in ms, at least one axis word is there, plane and feed
// mode fit. It checks what only the cycle knows (words that are missing or out of range, R below
// Z), and fills in `cycle`. Then gcode_cycle_next() yields one entry after the other until it
// returns false. First all of them are checked, with a copy of `cycle` (soft limits, reach); if all
// are right a second run of them is queued, as there is room. So cycle is plain data, and next()
// depends on nothing else.
#ifndef GCODE_CYCLE_H
#define GCODE_CYCLE_H

#include "gcode/gcode_sink.h"
#include "gcode/gcode_words.h"

typedef struct {
    gcode_cycle_words_t words; // as they will stay in force: kept if the line is accepted
    motion_t motion;
    double feed;                // mm/min
    double at[AXIS_COUNT];      // where the last entry ended
    bool relative;              // G91
    double step[AXIS_Z];        // what X and Y advance with each repetition, or where they go
    double hole_z, r_z, back_z; // machine coordinates
    double depth;               // reached so far in this hole, machine coordinate
    uint32_t repeats;           // holes left
    uint32_t stage;             // within a hole
} gcode_cycle_t;

// `from` is where the machine will be, `offset` leads from work to machine coordinates. `before`
// is what earlier lines of the same cycle have set; `first`: there was none.
err_t gcode_cycle_begin(gcode_cycle_t *cycle, const line_t *line, const gcode_cycle_words_t *before,
                        bool first, const double from[AXIS_COUNT], const double offset[AXIS_COUNT]);

// The next entry; false: the cycle's work is done.
bool gcode_cycle_next(gcode_cycle_t *cycle, gcode_entry_t *entry);

#endif
