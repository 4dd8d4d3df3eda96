// Canned cycles: G73, G81, G82 and G83 as a sequence of moves and dwells. Context: main loop.
#include "gcode/gcode_cycle.h"

err_t gcode_cycle_begin(gcode_cycle_t *cycle, const line_t *line, const gcode_cycle_words_t *before,
                        bool first, const double from[AXIS_COUNT],
                        const double offset[AXIS_COUNT]) {
    (void)cycle;
    (void)line;
    (void)before;
    (void)first;
    (void)from;
    (void)offset;
    return err_raise(ERR_GCODE_NO_CYCLES, NULL);
}

bool gcode_cycle_next(gcode_cycle_t *cycle, gcode_entry_t *entry) {
    (void)cycle;
    (void)entry;
    return false;
}
