// The words the language knows: statements, functions, and the first words of the configuration's
// rows. One hash table, made once. Context: main loop.
#ifndef BASIC_WORDS_H
#define BASIC_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#include "basic/basic.h"

#define WORDS_NONE (-1)
#define WORDS_ROWS_MAX 256u // of each kind

typedef enum {
    WORDS_STATEMENT, // row of statements_table
    WORDS_FUNCTION,  // row of functions_table
    WORDS_COMMAND,   // first row of the configuration's commands with this first word
    WORDS_HOST_FUNCTION,
    WORDS_ASSIGNMENT, // row of the configuration's assignments
} words_kind_t;

// Fills the table.
void words_start(void);

// The row, or WORDS_NONE. Case does not matter.
int words_find(words_kind_t kind, const char *text, size_t length);

// The configuration's next row with the same first word (commands, functions), or WORDS_NONE.
int words_next(words_kind_t kind, int row);

// Words that cannot name a variable: AND, TO, THEN ...
bool words_is_reserved(const char *text, size_t length);

#endif
