// Arcs of G2 and G3: the centre, by I J K or by R. Context: main loop.
#include "gcode/gcode_arc.h"

#include <math.h>

#include "gcode/gcode_offsets.h"

#define SAME_PLACE_MM 1e-6
#define RADIUS_MIN_MM 0.001

// By plane_t; counter-clockwise is from the first to the second axis.
static const axis_id_t planes[][2] = {
    {AXIS_X, AXIS_Y},
    {AXIS_Z, AXIS_X},
    {AXIS_Y, AXIS_Z},
};

static char letter_of(axis_id_t axis) {
    return GCODE_CENTRE_LETTERS[axis];
}

// Half a circle is the largest arc of a positive R and the smallest of a negative one. If R falls
// short of it by no more than rounded coordinates may, it is meant.
static err_t centre_by_radius(stepper_arc_t *arc, double r, const double start[AXIS_COUNT]) {
    double x = arc->move.target[arc->plane[0]] - start[arc->plane[0]];
    double y = arc->move.target[arc->plane[1]] - start[arc->plane[1]];
    double chord = sqrt(x * x + y * y);
    double radius = fabs(r);
    if (!(radius >= RADIUS_MIN_MM)) {
        return err_raise(ERR_ARC_NO_RADIUS, NULL);
    }
    if (chord <= SAME_PLACE_MM) {
        return err_raise(ERR_GCODE_ARC_FULL, NULL);
    }
    double missing = 0.5 * chord - radius;
    if (missing > STEPPER_ARC_ROUNDING_MM) {
        return err_raise(ERR_GCODE_ARC_SMALL, "%.3f mm", 0.5 * chord);
    }
    double height = missing >= 0.0 ? 0.0 : sqrt(radius * radius - 0.25 * chord * chord);
    double left = arc->clockwise != (r < 0.0) ? -height / chord : height / chord;
    arc->centre[0] = 0.5 * x - left * y;
    arc->centre[1] = 0.5 * y + left * x;
    return ERR_OK;
}

// The centre's words count from the start, or with G90.1 from the work zero.
static err_t centre_by_words(stepper_arc_t *arc, const line_t *line, const gcode_state_t *state,
                             const double start[AXIS_COUNT]) {
    const axis_id_t *plane = arc->plane;
    for (unsigned n = 0; n < 2; n++) {
        word_t word = (word_t)(WORD_I + plane[n]);
        arc->centre[n] = line_has(line, word) ? line->value[word] : 0.0;
        if (!line->modal.centre_absolute) {
            continue;
        }
        if (!line_has(line, word)) {
            return err_raise(ERR_GCODE_ARC_ABSOLUTE, "%c %c", letter_of(plane[0]),
                             letter_of(plane[1]));
        }
        arc->centre[n] += gcode_offsets_of(state, &line->modal, plane[n]) - start[plane[n]];
    }
    return ERR_OK;
}

err_t gcode_arc_find(stepper_arc_t *arc, const line_t *line, const gcode_state_t *state,
                     const double from[AXIS_COUNT]) {
    const axis_id_t *plane = planes[line->modal.plane];
    axis_id_t across = (axis_id_t)(AXIS_X + AXIS_Y + AXIS_Z - plane[0] - plane[1]);
    arc->clockwise = line->modal.motion == MOTION_ARC_CW;
    arc->turns = line_has(line, WORD_P) ? (uint32_t)line->value[WORD_P] : 1;
    arc->plane[0] = plane[0];
    arc->plane[1] = plane[1];
    if (line_has(line, (word_t)(WORD_I + across))) {
        return err_raise(ERR_GCODE_ARC_PLANE, "%c", letter_of(across));
    }
    bool by_radius = line_has(line, WORD_R);
    if (by_radius == ((line->words & WORDS_CENTRE) != 0)) {
        return err_raise(ERR_GCODE_ARC_CENTRE, "%c %c", letter_of(plane[0]), letter_of(plane[1]));
    }
    return by_radius ? centre_by_radius(arc, line->value[WORD_R], from)
                     : centre_by_words(arc, line, state, from);
}
