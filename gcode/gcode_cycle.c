// Canned cycles: G73, G81, G82 and G83 as a sequence of moves and dwells. Context: main loop.
//
//   initial  ----> place ....                .--> back to the initial plane (G98) or to R (G99)
//                          | rapid           |
//   R               .......v.................|..
//                          | feed            | rapid
//   depth                  v---- dwell ------'
#include "gcode/gcode_cycle.h"

#include <math.h>
#include <string.h>

// How far G73 lifts the tool to break the chip, and how far above the last depth G83 goes on at the
// feed: 0.010 inch.
#define BREAK_MM 0.254
#define REPEATS_MAX 9999.0
// A line is checked as a whole, so it may not stand for any number of moves.
#define PECKS_MAX 2000.0

typedef enum {
    STAGE_LIFT, // from below R
    STAGE_PLACE,
    STAGE_CLEAR, // down to R
    STAGE_FEED,
    STAGE_OUT, // of the hole, G83
    STAGE_IN,  // back to near the depth
    STAGE_DWELL,
    STAGE_BACK
} stage_t;

// ---- Beginning ----------------------------------------------------------------------------------

static err_t needs(const line_t *line, const char *what) {
    static const char *const codes[] = {"G73", "G81", "G82", "G83"};
    return err_raise(ERR_GCODE_NEEDS, "%s needs %s", codes[line->modal.motion - MOTION_CYCLE_CHIPS],
                     what);
}

static bool pecks(motion_t motion) {
    return motion == MOTION_CYCLE_CHIPS || motion == MOTION_CYCLE_PECK;
}

// Takes over the words of the line; those that are left out stay as the lines before have set them.
static err_t read_words(gcode_cycle_words_t *words, const line_t *line) {
    bool again = words->motion == line->modal.motion;
    if (!again && !line_has(line, WORD_Z)) {
        return needs(line, "Z, the depth");
    }
    if (!again && !line_has(line, WORD_R)) {
        return needs(line, "R, from where the way down is at the feed");
    }
    if (!again && pecks((motion_t)line->modal.motion) && !line_has(line, WORD_Q)) {
        return needs(line, "Q, the depth of each peck");
    }
    if (!again && line->modal.motion == MOTION_CYCLE_DWELL && !line_has(line, WORD_P)) {
        return needs(line, "P, the time at the bottom");
    }
    words->motion = line->modal.motion;
    words->z = line_has(line, WORD_Z) ? line->value[WORD_Z] : words->z;
    words->r = line_has(line, WORD_R) ? line->value[WORD_R] : words->r;
    words->q = line_has(line, WORD_Q) ? line->value[WORD_Q] : words->q;
    words->p = line_has(line, WORD_P) ? line->value[WORD_P] : words->p;
    return ERR_OK;
}

static err_t check_repeats(const line_t *line, double *repeats) {
    *repeats = line_has(line, WORD_L) ? line->value[WORD_L] : 1.0;
    if (!(*repeats >= 1.0 && *repeats <= REPEATS_MAX && *repeats == floor(*repeats))) {
        return err_raise(ERR_GCODE_RANGE, "L: %g is invalid (valid is 1 to %.0f)", *repeats,
                         REPEATS_MAX);
    }
    return ERR_OK;
}

static err_t check_shape(const gcode_cycle_t *cycle, const line_t *line, double repeats) {
    if (cycle->r_z < cycle->hole_z) {
        return err_raise(ERR_GCODE_CYCLE_UP, NULL);
    }
    if (!pecks(cycle->motion)) {
        return repeats <= PECKS_MAX ? ERR_OK : err_raise(ERR_GCODE_CYCLE_LONG, NULL);
    }
    if (!(cycle->words.q > 0.0)) {
        double typed = line->modal.inches ? cycle->words.q / GCODE_MM_PER_INCH : cycle->words.q;
        return err_raise(ERR_GCODE_RANGE, "Q: %.10g is invalid (valid is above 0)", typed);
    }
    bool fits = (cycle->r_z - cycle->hole_z) / cycle->words.q * repeats <= PECKS_MAX;
    return fits ? ERR_OK : err_raise(ERR_GCODE_CYCLE_LONG, NULL);
}

// R and Z: with G91 R counts from where the tool is, Z from R.
static void find_planes(gcode_cycle_t *cycle, const line_t *line, const double from[AXIS_COUNT],
                        const double offset[AXIS_COUNT]) {
    bool relative = line->modal.relative;
    cycle->r_z = cycle->words.r + (relative ? from[AXIS_Z] : offset[AXIS_Z]);
    cycle->hole_z = cycle->words.z + (relative ? cycle->r_z : offset[AXIS_Z]);
    cycle->back_z =
        line->modal.retract_to_r ? cycle->r_z : fmax(cycle->r_z, cycle->words.initial_z);
}

// What X and Y advance with each repetition (G91), or where they go.
static void find_step(gcode_cycle_t *cycle, const line_t *line, const double from[AXIS_COUNT],
                      const double offset[AXIS_COUNT]) {
    cycle->relative = line->modal.relative;
    for (axis_id_t axis = AXIS_X; axis <= AXIS_Y; axis++) {
        bool given = line_has(line, (word_t)axis);
        double value = line->value[axis];
        if (cycle->relative) {
            cycle->step[axis] = given ? value : 0.0;
        } else {
            cycle->step[axis] = given ? value + offset[axis] : from[axis];
        }
    }
}

err_t gcode_cycle_begin(gcode_cycle_t *cycle, const line_t *line, const gcode_cycle_words_t *before,
                        bool first, const double from[AXIS_COUNT],
                        const double offset[AXIS_COUNT]) {
    if (line_has(line, WORD_A)) {
        return err_raise(ERR_GCODE_CYCLE_A, NULL);
    }
    cycle->words = *before;
    if (first) {
        cycle->words.motion = MOTION_NONE;
        cycle->words.initial_z = from[AXIS_Z];
    }
    double repeats;
    err_t err = read_words(&cycle->words, line);
    if (err == ERR_OK) {
        err = check_repeats(line, &repeats);
    }
    if (err != ERR_OK) {
        return err;
    }
    cycle->motion = (motion_t)line->modal.motion;
    cycle->feed = line->modal.feed;
    cycle->repeats = (uint32_t)repeats;
    cycle->stage = STAGE_LIFT;
    memcpy(cycle->at, from, sizeof cycle->at);
    find_planes(cycle, line, from, offset);
    find_step(cycle, line, from, offset);
    return check_shape(cycle, line, repeats);
}

// ---- Its entries --------------------------------------------------------------------------------

static void move(gcode_entry_t *entry, const gcode_cycle_t *cycle, bool rapid) {
    entry->kind = ENTRY_MOVE;
    entry->arc.move = (stepper_move_t){
        .feed = cycle->feed,
        .rapid = rapid,
        .corner = STEPPER_CORNER_EXACT,
    };
    memcpy(entry->arc.move.target, cycle->at, sizeof cycle->at);
}

// A move of Z; false if it is there.
static bool move_z(gcode_cycle_t *cycle, gcode_entry_t *entry, double z, bool rapid) {
    bool away = cycle->at[AXIS_Z] != z;
    cycle->at[AXIS_Z] = z;
    move(entry, cycle, rapid);
    return away;
}

static bool move_to_place(gcode_cycle_t *cycle, gcode_entry_t *entry) {
    bool away = false;
    for (axis_id_t axis = AXIS_X; axis <= AXIS_Y; axis++) {
        double next = cycle->step[axis] + (cycle->relative ? cycle->at[axis] : 0.0);
        away = away || next != cycle->at[axis];
        cycle->at[axis] = next;
    }
    move(entry, cycle, true);
    return away;
}

// The next peck, or all the way down.
static bool feed_down(gcode_cycle_t *cycle, gcode_entry_t *entry) {
    double next = cycle->depth - cycle->words.q;
    if (pecks(cycle->motion) && next > cycle->hole_z) {
        cycle->depth = next;
        cycle->stage = cycle->motion == MOTION_CYCLE_PECK ? STAGE_OUT : STAGE_IN;
        return move_z(cycle, entry, next, false);
    }
    cycle->stage = cycle->motion == MOTION_CYCLE_DWELL ? STAGE_DWELL : STAGE_BACK;
    return move_z(cycle, entry, cycle->hole_z, false);
}

static bool dwell(const gcode_cycle_t *cycle, gcode_entry_t *entry) {
    entry->kind = ENTRY_DWELL;
    entry->dwell.ms = cycle->words.p;
    entry->dwell.lit = false;
    return true;
}

// Carries the stage out and goes to the next; false if there was nothing to do.
static bool do_stage(gcode_cycle_t *cycle, gcode_entry_t *entry) {
    stage_t stage = (stage_t)cycle->stage;
    cycle->stage++;
    switch (stage) {
    case STAGE_LIFT:
        return cycle->at[AXIS_Z] < cycle->r_z && move_z(cycle, entry, cycle->r_z, true);
    case STAGE_PLACE:
        return move_to_place(cycle, entry);
    case STAGE_CLEAR:
        cycle->depth = cycle->r_z;
        return move_z(cycle, entry, cycle->r_z, true);
    case STAGE_FEED:
        return feed_down(cycle, entry);
    case STAGE_OUT:
        return move_z(cycle, entry, cycle->r_z, true);
    case STAGE_IN:
        cycle->stage = STAGE_FEED;
        return move_z(cycle, entry, cycle->depth + fmin(BREAK_MM, cycle->words.q), true);
    case STAGE_DWELL:
        return dwell(cycle, entry);
    case STAGE_BACK:
        cycle->stage = STAGE_PLACE;
        cycle->repeats--;
        return move_z(cycle, entry, cycle->back_z, true);
    }
    return false;
}

bool gcode_cycle_next(gcode_cycle_t *cycle, gcode_entry_t *entry) {
    while (cycle->repeats > 0) {
        if (do_stage(cycle, entry)) {
            return true;
        }
    }
    return false;
}
