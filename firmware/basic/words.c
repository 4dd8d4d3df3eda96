// The words of the language, hashed. Context: main loop.
#include "words.h"

#include <string.h>

#include "functions.h"
#include "lexer.h"
#include "statements.h"

#define SLOTS 512u // power of two, more than twice the number of words

static const basic_config_t *config;

static struct {
    uint16_t slots[SLOTS];           // 0: free, otherwise 1 + kind and row
    int16_t next[2][WORDS_ROWS_MAX]; // chains of rows with one first word: commands, functions
} words;

static const char *const reserved[] = {
    "AND", "AS", "CASE", "ELSE", "ELSEIF",   "GOSUB", "GOTO", "INV",   "IS",  "MOD",
    "NOT", "OR", "STEP", "SUB",  "FUNCTION", "THEN",  "TO",   "UNTIL", "XOR",
};

static const char *name_of(words_kind_t kind, size_t row) {
    switch (kind) {
    case WORDS_STATEMENT:
        return statements_table[row].name;
    case WORDS_FUNCTION:
        return functions_table[row].name;
    case WORDS_COMMAND:
        return config->commands[row].name;
    case WORDS_HOST_FUNCTION:
        return config->functions[row].name;
    default:
        return config->assignments[row].name;
    }
}

static bool is_word(uint16_t slot, words_kind_t kind, const char *text, size_t length) {
    if ((slot - 1u) / WORDS_ROWS_MAX != (unsigned)kind) {
        return false;
    }
    const char *name = name_of(kind, (slot - 1u) % WORDS_ROWS_MAX);
    return letters_same(name, text, length) && // not beyond the end of the name, which differs
           (name[length] == '\0' || name[length] == ' ');
}

// The slot that holds the word, or the free one where it belongs.
static uint16_t *slot_of(words_kind_t kind, const char *text, size_t length) {
    unsigned hash = (unsigned)kind;
    for (size_t i = 0; i < length; i++) {
        hash = hash * 31 + (unsigned char)letters_upper(text[i]);
    }
    hash ^= hash >> 9;
    while (words.slots[hash % SLOTS] != 0 &&
           !is_word(words.slots[hash % SLOTS], kind, text, length)) {
        hash++;
    }
    return &words.slots[hash % SLOTS];
}

// Rows in turn: a later one with the same first word comes first in the chain.
static void add_rows(words_kind_t kind, size_t count) {
    for (size_t row = 0; row < count && row < WORDS_ROWS_MAX; row++) {
        const char *name = name_of(kind, row);
        uint16_t *slot = slot_of(kind, name, strcspn(name, " "));
        if (*slot != 0) {
            words.next[kind - WORDS_COMMAND][row] = (int16_t)((*slot - 1u) % WORDS_ROWS_MAX);
        }
        *slot = (uint16_t)(1u + kind * WORDS_ROWS_MAX + row);
    }
}

void words_start(const basic_config_t *new_config) {
    config = new_config;
    memset(&words, 0, sizeof words);
    memset(words.next, 0xFF, sizeof words.next); // WORDS_NONE
    add_rows(WORDS_STATEMENT, statements_count);
    add_rows(WORDS_FUNCTION, functions_count);
    add_rows(WORDS_COMMAND, config->command_count);
    add_rows(WORDS_HOST_FUNCTION, config->function_count);
    add_rows(WORDS_ASSIGNMENT, config->assignment_count); // all first words differ: no chains
}

int words_find(words_kind_t kind, const char *text, size_t length) {
    uint16_t slot = *slot_of(kind, text, length);
    return slot != 0 ? (int)((slot - 1u) % WORDS_ROWS_MAX) : WORDS_NONE;
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
