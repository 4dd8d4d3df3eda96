// The words of a line: what each sets and what they mean together. Inside gcode/ only. Context:
// main loop.
#ifndef GCODE_WORDS_H
#define GCODE_WORDS_H

#include "gcode/gcode.h"

#define GCODE_CENTRE_LETTERS "IJK" // indexed by axis_id_t

typedef enum { MOTION_NONE, MOTION_RAPID, MOTION_FEED, MOTION_ARC_CW, MOTION_ARC_CCW } motion_t;

typedef struct {
    motion_t motion;
    bool relative;
    gcode_plane_t plane;
    gcode_path_t path;
    double feed; // units/min, 0: not set
} modal_t;

// What a line asks for, besides its axis words and parameters.
typedef enum {
    ACTION_NONE,
    ACTION_MOVE,
    ACTION_DWELL,
    ACTION_HOME,
    ACTION_OFFSET,
    ACTION_SPINDLE
} action_t;

// Modal groups: of each a line may have one word.
typedef enum {
    GROUP_MOTION,
    GROUP_DISTANCE,
    GROUP_PLANE,
    GROUP_PATH,
    GROUP_CENTRE,
    GROUPS
} group_t;

typedef struct {
    action_t action;
    bool spindle_on;
    uint32_t groups; // bit n: group n has a word
    modal_t modal;   // as it will be after the line
    uint32_t axes;   // bit n: axis n has a word
    double axis[AXIS_COUNT];
    uint32_t centres; // bit n: the centre's offset along axis n (I, J, K) has a word
    double centre[AXIS_A];
    bool has_feed, has_p, has_r;
    double p, r;
} line_t;

// Reads the words of a line, beginning with the modal state before it.
err_t gcode_words_read(line_t *line, const modal_t *before, const gcode_word_t *words,
                       size_t count);

static inline bool line_is_arc(const line_t *line) {
    return line->modal.motion == MOTION_ARC_CW || line->modal.motion == MOTION_ARC_CCW;
}

#endif
