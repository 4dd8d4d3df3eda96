// Which part of a line is a keyword, a string, a number, a comment. Context: main loop.
#include "editor_colour.h"

#include "editor_text.h"
#include "lexer.h"
#include "symbols.h"
#include "words.h"

editor_colour_t editor_colour_line(size_t place) {
    return (editor_colour_t){.until = place};
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static size_t end_of_word(size_t place) {
    while (lexer_is_name_part(editor_text_at(place))) {
        place++;
    }
    char suffix = editor_text_at(place);
    return place + (suffix == '$' || suffix == '%' || suffix == '!');
}

static size_t end_of_string(size_t place) {
    char c;
    do {
        c = editor_text_at(++place);
    } while (c != '"' && c != '\n' && c != '\0');
    return place + (c == '"');
}

static editor_screen_look_t look_of_word(const char *word, size_t length) {
    if (words_is_reserved(word, length)) {
        return EDITOR_SCREEN_KEYWORD;
    }
    for (int kind = WORDS_STATEMENT; kind <= WORDS_HOST_FUNCTION; kind++) {
        if (words_find((words_kind_t)kind, word, length) != WORDS_NONE) {
            return EDITOR_SCREEN_KEYWORD;
        }
    }
    return EDITOR_SCREEN_TEXT;
}

static void take_word(editor_colour_t *colour, size_t place) {
    char word[SYMBOLS_NAME_MAX];
    size_t length = end_of_word(place) - place;
    colour->until = place + length;
    colour->look = EDITOR_SCREEN_TEXT;
    if (length > sizeof word) {
        return;
    }
    editor_text_copy(place, length, word);
    colour->look = look_of_word(word, length);
    if (lexer_same(word, length, "REM")) {
        colour->look = EDITOR_SCREEN_COMMENT;
        colour->until = editor_text_line_end(place);
    }
}

editor_screen_look_t editor_colour_at(editor_colour_t *colour, size_t place) {
    if (place < colour->until) {
        return colour->look;
    }
    char c = editor_text_at(place);
    if (c == '"') {
        colour->look = EDITOR_SCREEN_STRING;
        colour->until = end_of_string(place);
    } else if (c == '\'') {
        colour->look = EDITOR_SCREEN_COMMENT;
        colour->until = editor_text_line_end(place);
    } else if (lexer_is_name_start(c)) {
        take_word(colour, place);
    } else if (is_digit(c) || (c == '.' && is_digit(editor_text_at(place + 1)))) {
        colour->look = EDITOR_SCREEN_NUMBER;
        colour->until = end_of_word(place + 1);
    } else {
        colour->look = EDITOR_SCREEN_TEXT;
        colour->until = place + 1;
    }
    return colour->look;
}
