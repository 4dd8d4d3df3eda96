// G-code text to words. Numbers are decimal only: in `Y0X10` the x is the next word, not a
// hexadecimal prefix, and `1E5` is a 1 and a word E. Context: main loop.
#include "gcode/gcode_lexer.h"

#include <ctype.h>
#include <string.h>

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == ',' || c == '\r' || c == '\n';
}

// Whether the text between p and end begins with `MSG,`, with blanks before; returns what is
// behind.
static const char *behind_msg(const char *p, const char *end) {
    static const char key[] = "MSG,";
    while (p < end && (*p == ' ' || *p == '\t')) {
        p++;
    }
    for (const char *k = key; *k != '\0'; k++, p++) {
        if (p == end || toupper((unsigned char)*p) != *k) {
            return NULL;
        }
    }
    return p;
}

static void keep_message(gcode_lexed_t *lexed, const char *p, const char *end) {
    const char *message = behind_msg(p, end);
    if (message != NULL) {
        lexed->message = message;
        lexed->message_length = (size_t)(end - message);
    }
}

// Past blanks and comments. A parenthesis that is never closed is a comment to the end of the line.
static const char *skip_blanks(const char *p, const char *end, gcode_lexed_t *lexed) {
    while (p < end) {
        if (is_blank(*p)) {
            p++;
        } else if (*p == '(') {
            const char *close = memchr(p, ')', (size_t)(end - p));
            keep_message(lexed, p + 1, close != NULL ? close : end);
            p = close != NULL ? close + 1 : end;
        } else if (*p == ';' || *p == '\'') {
            p = end;
        } else {
            break;
        }
    }
    return p;
}

static err_t unexpected(char c) {
    unsigned char byte = (unsigned char)c;
    if (isprint(byte)) {
        return err_raise(ERR_GCODE_SYNTAX, "%c", c);
    }
    return err_raise(ERR_GCODE_SYNTAX, "byte %u", byte);
}

// The number at `p`, with its sign. NULL if there is none.
static const char *read_number(const char *p, const char *end, double *value,
                               gcode_lexed_t *lexed) {
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) {
        p = skip_blanks(p + 1, end, lexed);
    }
    num_t number;
    p = num_parse(p, end, false, &number);
    if (p != NULL) {
        *value = negative ? -number.value : number.value;
    }
    return p;
}

// Past what may stand before the first word; `end` if the line counts for nothing.
static const char *begin(const char *text, const char *end, bool block_delete,
                         gcode_lexed_t *lexed) {
    const char *p = skip_blanks(text, end, lexed);
    if (p < end && *p == '/') {
        p = block_delete ? end : skip_blanks(p + 1, end, lexed);
    }
    return p < end && *p == '%' ? end : p;
}

// Whether the axis letter that would be the next word names an axis to home, so that nobody asks
// for its number. A sign needs one all the same.
static bool names_axis_to_home(const gcode_lexed_t *lexed, const char *p, const char *end,
                               bool nist) {
    char letter = lexed->words[lexed->count].letter;
    if (strchr(STEPPER_AXIS_LETTERS, letter) == NULL || (p < end && (*p == '-' || *p == '+'))) {
        return false;
    }
    for (size_t i = 0; i < lexed->count; i++) {
        const gcode_word_t *word = &lexed->words[i];
        if (word->letter == 'G' && (word->value == 28.2 || (word->value == 28.0 && !nist))) {
            return true;
        }
    }
    return false;
}

err_t gcode_lexer_split(const char *text, size_t length, const gcode_options_t *options,
                        gcode_lexed_t *lexed) {
    const char *end = text + length;
    lexed->count = 0;
    lexed->message_length = 0;
    for (const char *p = begin(text, end, options->block_delete, lexed); p < end;
         p = skip_blanks(p, end, lexed)) {
        if (!isalpha((unsigned char)*p)) {
            return unexpected(*p);
        }
        if (toupper((unsigned char)*p) == 'O') {
            return err_raise(ERR_GCODE_O_WORD, NULL); // what follows may be of any form
        }
        if (lexed->count == GCODE_WORDS_MAX) {
            return err_raise(ERR_GCODE_TOO_MANY_WORDS, NULL);
        }
        gcode_word_t *word = &lexed->words[lexed->count];
        word->letter = (char)toupper((unsigned char)*p);
        const char *number = skip_blanks(p + 1, end, lexed);
        p = read_number(number, end, &word->value, lexed);
        if (p == NULL && names_axis_to_home(lexed, number, end, options->nist)) {
            word->value = 0.0;
            p = number;
        }
        if (p == NULL) {
            return err_raise(ERR_GCODE_MISSING_VALUE, "%c", word->letter);
        }
        lexed->count++;
    }
    return ERR_OK;
}
