// The words of the language, hashed. Context: main loop.
#include "words.h"

#include <string.h>

#include "functions.h"
#include "lexer.h"
#include "statements.h"

#define SLOTS 512u // power of two, more than twice the number of words
#define ROWS_MAX 128u

typedef struct {
    const char *text;
    uint8_t length;
    uint8_t kind;
    int16_t row;
} word_t;

static struct {
    word_t slots[SLOTS];
    int16_t next[2][ROWS_MAX]; // chains of rows with one first word: commands, functions
} words;

static const char *const reserved[] = {
    "AND", "AS", "CASE", "ELSE", "ELSEIF", "GOSUB", "GOTO", "INV", "IS", "MOD", "NOT",
    "OR", "STEP", "SUB", "FUNCTION", "THEN", "TO", "UNTIL", "XOR",
};

static char upper(char c) {
    return c >= 'a' && c <= 'z' ? (char)(c - 0x20) : c;
}

// The slot that holds the word, or the free one where it belongs.
static word_t *slot_of(words_kind_t kind, const char *text, size_t length) {
    unsigned hash = (unsigned)kind;
    for (size_t i = 0; i < length; i++) {
        hash = hash * 31 + (unsigned char)upper(text[i]);
    }
    hash ^= hash >> 9;
    for (;; hash++) {
        word_t *word = &words.slots[hash % SLOTS];
        if (word->text == NULL) {
            return word;
        }
        if (word->kind == kind && word->length == length) {
            size_t same = 0;
            while (same < length && upper(word->text[same]) == upper(text[same])) {
                same++;
            }
            if (same == length) {
                return word;
            }
        }
    }
}

static void add(words_kind_t kind, const char *text, size_t length, size_t row) {
    word_t *word = slot_of(kind, text, length);
    if (word->text != NULL) { // a further row with this first word
        int16_t *next = words.next[kind - WORDS_COMMAND];
        next[row] = word->row;
    }
    *word = (word_t){text, (uint8_t)length, (uint8_t)kind, (int16_t)row};
}

void words_start(const basic_config_t *config) {
    memset(&words, 0, sizeof words);
    memset(words.next, 0xFF, sizeof words.next); // WORDS_NONE
    for (size_t i = 0; i < statements_count; i++) {
        add(WORDS_STATEMENT, statements_table[i].name, strlen(statements_table[i].name), i);
    }
    for (size_t i = 0; i < functions_count; i++) {
        add(WORDS_FUNCTION, functions_table[i].name, strlen(functions_table[i].name), i);
    }
    for (size_t i = 0; i < config->command_count && i < ROWS_MAX; i++) {
        add(WORDS_COMMAND, config->commands[i].name, strcspn(config->commands[i].name, " "), i);
    }
    for (size_t i = 0; i < config->function_count && i < ROWS_MAX; i++) {
        add(WORDS_HOST_FUNCTION, config->functions[i].name, strlen(config->functions[i].name), i);
    }
}

int words_find(words_kind_t kind, const char *text, size_t length) {
    const word_t *word = slot_of(kind, text, length);
    return word->text != NULL ? word->row : WORDS_NONE;
}

int words_next(words_kind_t kind, int row) {
    return words.next[kind - WORDS_COMMAND][row];
}

bool words_is_reserved(const char *text, size_t length) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(reserved); i++) {
        if (lexer_same(text, length, reserved[i])) {
            return true;
        }
    }
    return false;
}
