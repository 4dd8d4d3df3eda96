// The words of a line: each is taken once and within its range. Context: main loop.
#include "gcode/gcode_words.h"

#include <math.h>

#include "gcode/gcode_check.h"
#include "gcode/gcode_codes.h"
#include "stepper/stepper_check.h"

#define NO_WORD WORDS

// By letter: which word it is.
static const uint8_t words_of_letters[26] = {
    ['A' - 'A'] = WORD_A,  ['B' - 'A'] = NO_WORD, ['C' - 'A'] = NO_WORD, ['D' - 'A'] = NO_WORD,
    ['E' - 'A'] = NO_WORD, ['F' - 'A'] = WORD_F,  ['G' - 'A'] = NO_WORD, ['H' - 'A'] = WORD_H,
    ['I' - 'A'] = WORD_I,  ['J' - 'A'] = WORD_J,  ['K' - 'A'] = WORD_K,  ['L' - 'A'] = WORD_L,
    ['M' - 'A'] = NO_WORD, ['N' - 'A'] = WORD_N,  ['O' - 'A'] = NO_WORD, ['P' - 'A'] = WORD_P,
    ['Q' - 'A'] = WORD_Q,  ['R' - 'A'] = WORD_R,  ['S' - 'A'] = WORD_S,  ['T' - 'A'] = WORD_T,
    ['U' - 'A'] = NO_WORD, ['V' - 'A'] = NO_WORD, ['W' - 'A'] = NO_WORD, ['X' - 'A'] = WORD_X,
    ['Y' - 'A'] = WORD_Y,  ['Z' - 'A'] = WORD_Z,
};

// Ranges of words that have the same one wherever they stand.
typedef struct {
    double min, max; // both 0: whatever
    bool whole;
} range_t;

static const range_t ranges[WORDS] = {
    [WORD_F] = {GCODE_FEED_MIN, GCODE_FEED_MAX, false},
    [WORD_H] = {0, 99999, true},
    [WORD_L] = {1, 9999, true},
    [WORD_N] = {0, 1e12, true},
    [WORD_S] = {0, 1000000, false},
    [WORD_T] = {0, 99999, true},
};

static err_t check_range(char letter, const range_t *range, double value) {
    if (!(value >= range->min && value <= range->max)) {
        return err_raise(ERR_GCODE_RANGE, "%c: %.10g is invalid (valid is %g to %g)", letter, value,
                         range->min, range->max);
    }
    if (range->whole && value != floor(value)) {
        return err_raise(ERR_GCODE_RANGE, "%c: %.10g is no whole number", letter, value);
    }
    return ERR_OK;
}

static err_t unknown_word(char letter) {
    return letter == 'O' ? err_raise(ERR_GCODE_O_WORD, NULL)
                         : err_raise(ERR_GCODE_UNKNOWN_WORD, "%c", letter);
}

static err_t read_value(line_t *line, char letter, double value) {
    unsigned index = (unsigned)(letter - 'A');
    word_t word =
        index < COUNT_OF_ARRAY(words_of_letters) ? (word_t)words_of_letters[index] : NO_WORD;
    if (word == NO_WORD) {
        return unknown_word(letter);
    }
    if (line_has(line, word)) {
        return err_raise(ERR_GCODE_TWICE, "%c", letter);
    }
    err_t err = word < (word_t)AXIS_COUNT ? stepper_check_axis((axis_id_t)word) : ERR_OK;
    if (err != ERR_OK) {
        return err;
    }
    line->words |= WORD_BIT(word);
    line->value[word] = value;
    return ranges[word].max > 0.0 ? check_range(letter, &ranges[word], value) : ERR_OK;
}

static err_t read_word(line_t *line, const gcode_word_t *word) {
    if (word->letter == 'G' || word->letter == 'M') {
        return gcode_codes_read(line, word->letter, word->value);
    }
    return read_value(line, word->letter, word->value);
}

err_t gcode_words_read(line_t *line, const gcode_state_t *before, const gcode_word_t *words,
                       size_t count) {
    line->modal = before->modal;
    line->words = 0;
    line->groups = 0;
    line->once = ONCE_NONE;
    line->length = LENGTH_NONE;
    line->stop = STOP_NONE;
    line->stored = STORED_G28;
    line->moves = false;
    err_t err = ERR_OK;
    for (size_t i = 0; i < count && err == ERR_OK; i++) {
        err = read_word(line, &words[i]);
    }
    return err == ERR_OK ? gcode_check(line, before) : err;
}
