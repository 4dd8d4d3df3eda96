// Tokens of one line. Context: main loop.
#include "lexer.h"

#include <string.h>

#include "base/base.h"
#include "errors.h"
#include "escapes.h"
#include "number_text.h"
#include "source_lines.h"

static struct {
    const char *end;
    lexer_token_t now;
    bool else_ends;
    bool escapes;
} lexer;

bool lexer_is_name_start(char c) {
    char lower = (char)(c | 0x20);
    return (lower >= 'a' && lower <= 'z') || c == '_';
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool lexer_is_name_part(char c) {
    return lexer_is_name_start(c) || is_digit(c) || c == '.';
}

static void read_name(const char *p) {
    lexer.now.kind = LEXER_NAME;
    lexer.now.suffix = 0;
    while (p < lexer.end && lexer_is_name_part(*p)) {
        p++;
    }
    if (p < lexer.end && (*p == '%' || *p == '!' || *p == '$')) {
        lexer.now.suffix = *p++;
    }
    lexer.now.behind = p;
}

static void read_number(const char *p) {
    lexer.now.kind = LEXER_NUMBER;
    size_t used = number_text_parse(p, (size_t)(lexer.end - p), &lexer.now.value);
    if (used == 0) {
        errors_fail(*p == '&' ? ERR_SYNTAX : ERR_NUMBER_TOO_LARGE);
    }
    lexer.now.behind = p + used;
}

// A missing closing quote is no error.
static void read_string(const char *p) {
    lexer.now.kind = LEXER_STRING;
    lexer.now.text = p + 1;
    const char *stop = p + 1;
    while (stop < lexer.end && *stop != '"') {
        stop += lexer.escapes && *stop == '\\' && stop + 1 < lexer.end ? 2 : 1;
    }
    lexer.now.length = (size_t)(stop - (p + 1));
    lexer.now.behind = stop < lexer.end && *stop == '"' ? stop + 1 : stop;
}

static void read_symbol(const char *p) {
    static const char pairs[] = "<><=>==<=>>><<";
    lexer.now.kind = LEXER_SYMBOL;
    lexer.now.symbol = (unsigned char)*p;
    lexer.now.behind = p + 1;
    if (p + 1 >= lexer.end) {
        return;
    }
    for (const char *pair = pairs; *pair != '\0'; pair += 2) {
        if (p[0] == pair[0] && p[1] == pair[1]) {
            lexer.now.symbol = LEXER_PAIR(p[0], p[1]);
            lexer.now.behind = p + 2;
        }
    }
}

// Blanks, and the joints between lines that are one.
static const char *skip_blanks(const char *p) {
    while (p < lexer.end) {
        if (source_lines_is_joint(p, lexer.end)) {
            p = (const char *)memchr(p, '\n', (size_t)(lexer.end - p)) + 1;
        } else if (*p == ' ' || *p == '\t') {
            p++;
        } else {
            break;
        }
    }
    return p;
}

static void read_token(const char *p) {
    p = skip_blanks(p);
    lexer.now.text = p;
    if (p >= lexer.end || *p == '\'') {
        lexer.now.kind = LEXER_END;
        lexer.now.length = 0;
        lexer.now.behind = p;
        return;
    }
    if (*p == '"') {
        read_string(p);
        return;
    }
    if (lexer_is_name_start(*p)) {
        read_name(p);
    } else if (is_digit(*p) || *p == '&' || (*p == '.' && p + 1 < lexer.end && is_digit(p[1]))) {
        read_number(p);
    } else {
        read_symbol(p);
    }
    lexer.now.length = (size_t)(lexer.now.behind - p);
}

void lexer_start(const char *text, const char *end) {
    lexer.end = end;
    lexer.else_ends = false;
    read_token(text);
}

void lexer_set_escapes(bool on) {
    lexer.escapes = on;
}

void lexer_go(const char *text) {
    read_token(text);
}

const char *lexer_line_end(void) {
    return lexer.end;
}

const lexer_token_t *lexer_now(void) {
    return &lexer.now;
}

void lexer_next(void) {
    if (lexer.now.kind != LEXER_END) {
        read_token(lexer.now.behind);
    }
}

size_t lexer_text(char *text) {
    if (lexer.now.length > VALUE_STRING_MAX) {
        errors_fail(ERR_STRING_TOO_LONG);
    }
    if (lexer.escapes) {
        return escapes_replace(text, lexer.now.text, lexer.now.length);
    }
    memcpy(text, lexer.now.text, lexer.now.length);
    return lexer.now.length;
}

bool lexer_is(int symbol) {
    return lexer.now.kind == LEXER_SYMBOL && lexer.now.symbol == symbol;
}

bool lexer_is_word(const char *word) {
    return lexer.now.kind == LEXER_NAME && lexer_same(lexer.now.text, lexer.now.length, word);
}

bool lexer_take(int symbol) {
    bool found = lexer_is(symbol);
    if (found) {
        lexer_next();
    }
    return found;
}

bool lexer_take_word(const char *word) {
    bool found = lexer_is_word(word);
    if (found) {
        lexer_next();
    }
    return found;
}

void lexer_expect(int symbol) {
    if (!lexer_take(symbol)) {
        errors_fail(ERR_SYNTAX);
    }
}

void lexer_expect_word(const char *word) {
    if (!lexer_take_word(word)) {
        errors_fail(ERR_SYNTAX);
    }
}

bool lexer_at_end(void) {
    return lexer.now.kind == LEXER_END || lexer_is(':') ||
           (lexer.else_ends && lexer_is_word("ELSE"));
}

bool lexer_set_else_ends(bool ends) {
    bool before = lexer.else_ends;
    lexer.else_ends = ends;
    return before;
}

bool lexer_else_ends(void) {
    return lexer.else_ends;
}

bool lexer_same(const char *text, size_t length, const char *word) {
    for (size_t i = 0; i < length; i++) {
        if (letters_upper(text[i]) != letters_upper(word[i]) || word[i] == '\0') {
            return false;
        }
    }
    return word[length] == '\0';
}

size_t lexer_bare_length(const lexer_token_t *name) {
    return name->suffix != 0 ? name->length - 1 : name->length;
}

uint8_t lexer_suffix_type(char suffix) {
    switch (suffix) {
    case '%':
        return VALUE_INTEGER;
    case '!':
        return VALUE_FLOAT;
    case '$':
        return VALUE_STRING;
    default:
        return VALUE_NONE;
    }
}
