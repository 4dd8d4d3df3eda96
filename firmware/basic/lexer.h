// Cuts one line of source text into tokens, one ahead of the compiler. Context: main loop.
#ifndef BASIC_LEXER_H
#define BASIC_LEXER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "value.h"

typedef enum {
    LEXER_END,    // of the line, or the start of a comment
    LEXER_NAME,   // letters, digits, _ and points, with a suffix if there is one
    LEXER_NUMBER, // value
    LEXER_STRING, // text without its quotes
    LEXER_SYMBOL, // one character, or two packed by LEXER_PAIR
} lexer_kind_t;

#define LEXER_PAIR(first, second) ((first) << 8 | (second))

typedef struct {
    lexer_kind_t kind;
    const char *text;
    size_t length;
    const char *behind; // the first character behind the token
    char suffix;        // of a name: % ! $ or 0; it is part of `text`
    int symbol;
    value_t value;
} lexer_token_t;

// Starts with the text from `text` to `end`, which stay valid while it is read.
void lexer_start(const char *text, const char *end);

// The token at hand; lexer_next() goes to the one behind it. Error: a numeral too large.
const lexer_token_t *lexer_now(void);
void lexer_next(void);

// OPTION ESCAPE: whether a backslash in a string stands for something, see lexer_text().
void lexer_set_escapes(bool on);

// The text of the string at hand with its escapes replaced; `text` has room for VALUE_STRING_MAX.
// Returns its length. Error: too long, an unknown escape.
size_t lexer_text(char *text);

// Puts the reader to `text`, a place in the same line.
void lexer_go(const char *text);
const char *lexer_line_end(void);

// True, and gone past, if it is the token at hand.
bool lexer_take(int symbol);
bool lexer_take_word(const char *word);

bool lexer_is(int symbol);
bool lexer_is_word(const char *word);

// Error unless it is the token at hand.
void lexer_expect(int symbol);
void lexer_expect_word(const char *word);

// True at the end of a statement: end of the line, a colon, or ELSE where
// lexer_set_else_ends(true).
bool lexer_at_end(void);

// Whether ELSE ends a statement just now (in a single-line IF). Returns what was set.
bool lexer_set_else_ends(bool ends);
bool lexer_else_ends(void);

// Compares words whatever their case; `word` is zero-terminated.
bool lexer_same(const char *text, size_t length, const char *word);

bool lexer_is_name_start(char c);
bool lexer_is_name_part(char c);

// The characters of a name without its suffix.
size_t lexer_bare_length(const lexer_token_t *name);

// The type a suffix stands for; VALUE_NONE without one.
uint8_t lexer_suffix_type(char suffix);

#endif
