// Looks through a G-code file of A: without moving anything: where it leads, how long it takes,
// what would be refused. A further face of gcode/. Context: main loop.
//
// It begins where the last queued move ends, with the modes and offsets that are in force, and
// leaves them as they are. Homing ends at the home position, probing meets nothing.
#ifndef GCODE_SURVEY_H
#define GCODE_SURVEY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "stepper/stepper.h"

typedef struct {
    double low, high;
} gcode_range_t;

typedef struct {
    uint32_t lines;                    // that were read
    uint32_t moves;                    // lines, arcs and probing moves
    uint32_t pauses;                   // M0, M1, M6
    uint32_t homings, probings;        // whose time is not known
    uint32_t axes;                     // bit n: axis n moves
    gcode_range_t machine[AXIS_COUNT]; // where the way of an axis that moves leads, all of it
    gcode_range_t work[AXIS_COUNT];    // the same as the program counts it
    double seconds;                    // of motion, dwells and spin-ups
    uint32_t beyond_line;              // the first that exceeds soft limits, 0: none
    axis_id_t beyond_axis;
} gcode_report_t;

// Memory that the caller lends, 8-aligned, GCODE_SURVEY_SIZE bytes.
#define GCODE_SURVEY_SIZE 2560u

// Fills in `report`. `go_on` is called every few lines; false ends it, as if the file were over.
// Errors: not initialised, the file cannot be read; of a line, number report->lines, that would be
// refused (soft limits apart), with the report up to there.
err_t gcode_survey(void *memory, const char *name, size_t length, bool (*go_on)(void),
                   gcode_report_t *report);

#endif
