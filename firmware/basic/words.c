// The words of the language, hashed. Context: main loop.
#include "words.h"

#include <string.h>

#include "functions.h"
#include "lexer.h"
#include "rows.h"
#include "statements.h"

#define SLOTS 512u // power of two, more than twice the number of words
#define FUNCTIONS_MAX 64u

static struct {
    uint16_t slots[SLOTS]; // 0: free, otherwise 1 + kind and row
    // Chains of rows with one first word: 1 + the next row, 0 at the end.
    uint8_t next_command[ROWS_MAX];
    uint8_t next_function[FUNCTIONS_MAX];
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
        return rows_command((unsigned)row)->name;
    case WORDS_HOST_FUNCTION:
        return rows_function((unsigned)row)->name;
    default:
        return rows_assignment((unsigned)row)->name;
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

static void add_row(words_kind_t kind, size_t row, uint8_t *next) {
    const char *name = name_of(kind, row);
    uint16_t *slot = slot_of(kind, name, strcspn(name, " "));
    if (*slot != 0 && next != NULL) {
        next[row] = (uint8_t)(1 + (*slot - 1u) % WORDS_ROWS_MAX);
    }
    *slot = (uint16_t)(1u + kind * WORDS_ROWS_MAX + row);
}

// Rows in turn: a later one with the same first word comes first in the chain.
void words_start(void) {
    memset(&words, 0, sizeof words);
    for (size_t row = 0; row < statements_count; row++) {
        add_row(WORDS_STATEMENT, row, NULL);
    }
    for (size_t row = 0; row < functions_count; row++) {
        add_row(WORDS_FUNCTION, row, NULL);
    }
    for (size_t row = 0; row < ROWS_MAX && rows_command((unsigned)row) != NULL; row++) {
        add_row(WORDS_COMMAND, row, words.next_command);
    }
    for (size_t row = 0; row < FUNCTIONS_MAX && rows_function((unsigned)row) != NULL; row++) {
        add_row(WORDS_HOST_FUNCTION, row, words.next_function);
    }
    // All their first words differ: no chains.
    for (size_t row = 0; row < ROWS_MAX && rows_assignment((unsigned)row) != NULL; row++) {
        add_row(WORDS_ASSIGNMENT, row, NULL);
    }
}

int words_find(words_kind_t kind, const char *text, size_t length) {
    uint16_t slot = *slot_of(kind, text, length);
    return slot != 0 ? (int)((slot - 1u) % WORDS_ROWS_MAX) : WORDS_NONE;
}

int words_next(words_kind_t kind, int row) {
    const uint8_t *next = kind == WORDS_COMMAND ? words.next_command : words.next_function;
    return next[row] - 1; // WORDS_NONE at the end
}

bool words_is_reserved(const char *text, size_t length) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(reserved); i++) {
        if (lexer_same(text, length, reserved[i])) {
            return true;
        }
    }
    return false;
}
