// The words of a line: what each sets and what they mean together. Inside gcode/ only. Context:
// main loop.
#ifndef GCODE_WORDS_H
#define GCODE_WORDS_H

#include "gcode/gcode_state.h"

#define GCODE_CENTRE_LETTERS "IJK" // indexed by axis_id_t

// Modal groups of RS274/NGC, G and M: of each a line may have one word.
typedef enum {
    GROUP_MOTION,
    GROUP_CYCLE_END, // G80; the first lines of many programs have it beside G0
    GROUP_ONCE,      // non-modal: G4, G10, G28, G30, G53, G92 and their like
    GROUP_PLANE,
    GROUP_DISTANCE,
    GROUP_CENTRE,
    GROUP_FEED_MODE,
    GROUP_UNITS,
    GROUP_COMPENSATION,
    GROUP_TOOL_LENGTH,
    GROUP_RETRACT,
    GROUP_SYSTEM,
    GROUP_PATH,
    GROUP_STOP,
    GROUP_TOOL_CHANGE,
    GROUP_SPINDLE,
    GROUP_COOLANT,
    GROUP_OVERRIDES,
    GROUPS
} group_t;

// Codes of GROUP_ONCE.
typedef enum {
    ONCE_NONE,
    ONCE_DWELL,         // G4
    ONCE_SET,           // G10
    ONCE_G28,           // homing, or to its stored place: the dialect decides
    ONCE_STORE_G28,     // G28.1
    ONCE_HOME,          // G28.2
    ONCE_G30,           // to its stored place
    ONCE_STORE_G30,     // G30.1
    ONCE_MACHINE,       // G53
    ONCE_SHIFT,         // G92
    ONCE_SHIFT_CLEAR,   // G92.1
    ONCE_SHIFT_SUSPEND, // G92.2
    ONCE_SHIFT_RESTORE, // G92.3
    ONCE_GO_STORED      // what G28 in NIST and G30 become
} once_t;

// Codes of GROUP_TOOL_LENGTH.
typedef enum { LENGTH_NONE, LENGTH_OF_TOOL, LENGTH_GIVEN } length_t;

// Codes of GROUP_STOP.
typedef enum { STOP_NONE, STOP_PAUSE, STOP_OPTIONAL, STOP_END } stop_t;

// Words with a value, besides G and M. The first AXIS_COUNT are the axes in their order.
typedef enum {
    WORD_X,
    WORD_Y,
    WORD_Z,
    WORD_A,
    WORD_I,
    WORD_J,
    WORD_K,
    WORD_F,
    WORD_H,
    WORD_L,
    WORD_N,
    WORD_P,
    WORD_Q,
    WORD_R,
    WORD_S,
    WORD_T,
    WORDS
} word_t;
#define GCODE_WORD_LETTERS "XYZAIJKFHLNPQRST" // indexed by word_t

#define WORD_BIT(word) (1u << (word))
#define WORDS_AXES 0xFu
#define WORDS_LINEAR 0x7u // X Y Z
#define WORDS_CENTRE (WORD_BIT(WORD_I) | WORD_BIT(WORD_J) | WORD_BIT(WORD_K))

typedef struct {
    uint32_t words;  // bit n: word n was given
    uint32_t groups; // bit n: group n has a word
    uint8_t once;    // once_t
    uint8_t length;  // length_t
    uint8_t stop;    // stop_t
    uint8_t stored;  // stored_t, with ONCE_GO_STORED
    bool moves;      // the axis words are for the motion mode
    modal_t modal;   // as it will be after the line
    double value[WORDS];
} line_t;

// Reads the words of a line, beginning with the state before it, and checks all that can be said
// without the machine.
err_t gcode_words_read(line_t *line, const gcode_state_t *before, const gcode_word_t *words,
                       size_t count);

static inline bool line_has(const line_t *line, word_t word) {
    return ((line->words >> word) & 1) != 0;
}

static inline bool line_has_group(const line_t *line, group_t group) {
    return ((line->groups >> group) & 1) != 0;
}

static inline bool line_is_arc(const line_t *line) {
    return line->modal.motion == MOTION_ARC_CW || line->modal.motion == MOTION_ARC_CCW;
}

static inline bool line_is_probe(const line_t *line) {
    return line->modal.motion >= MOTION_PROBE_TO && line->modal.motion <= MOTION_PROBE_OFF_MAYBE;
}

static inline bool line_is_cycle(const line_t *line) {
    return line->modal.motion >= MOTION_CYCLE_CHIPS;
}

#endif
