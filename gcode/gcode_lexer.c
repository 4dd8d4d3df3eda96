// G-code text to words. Numbers are decimal only: in `Y0X10` the x is the next word, not a
// hexadecimal prefix, and `1E5` is a 1 and a word E. Context: main loop.
#include "gcode/gcode_lexer.h"

#include <ctype.h>
#include <string.h>

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == ',' || c == '\r' || c == '\n';
}

// Past blanks and comments. A parenthesis that is never closed is a comment to the end of the line.
static const char *skip_blanks(const char *p, const char *end) {
    while (p < end) {
        if (is_blank(*p)) {
            p++;
        } else if (*p == '(') {
            const char *close = memchr(p, ')', (size_t)(end - p));
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
static const char *read_number(const char *p, const char *end, double *value) {
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) {
        p = skip_blanks(p + 1, end);
    }
    num_t number;
    p = num_parse(p, end, false, &number);
    if (p != NULL) {
        *value = negative ? -number.value : number.value;
    }
    return p;
}

err_t gcode_lexer_split(const char *text, size_t length, gcode_word_t *words, size_t *count) {
    const char *end = text + length;
    *count = 0;
    for (const char *p = skip_blanks(text, end); p < end; p = skip_blanks(p, end)) {
        if (!isalpha((unsigned char)*p)) {
            return unexpected(*p);
        }
        if (*count == GCODE_WORDS_MAX) {
            return err_raise(ERR_GCODE_TOO_MANY_WORDS, NULL);
        }
        gcode_word_t *word = &words[*count];
        word->letter = (char)toupper((unsigned char)*p);
        p = read_number(skip_blanks(p + 1, end), end, &word->value);
        if (p == NULL) {
            return err_raise(ERR_GCODE_MISSING_VALUE, "%c", word->letter);
        }
        (*count)++;
    }
    return ERR_OK;
}
