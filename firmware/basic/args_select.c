// Commands of one name that differ in a word among their arguments: SETPIN GP2, DIN and SETPIN GP2,
// PWM are rows of their own. Context: main loop, while compiling.
#include "args_select.h"

#include <string.h>

#include "args.h"
#include "base/base.h"
#include "choices.h"
#include "errors.h"
#include "lexer.h"
#include "rows.h"
#include "words.h"

// The argument whose word takes the row; NULL: the row has none.
static const basic_arg_spec_t *selector_of(const basic_command_t *row) {
    for (size_t i = 0; i < row->arg_count; i++) {
        if (row->args[i].flags & BASIC_ARG_SELECTS) {
            return &row->args[i];
        }
    }
    return NULL;
}

// Goes to the argument at `index` of those that start at `start`.
static void go_to_argument(const char *start, size_t index) {
    unsigned depth = 0;
    lexer_go(start);
    while (index > 0 && !lexer_at_end()) {
        depth += lexer_is('(');
        depth -= depth > 0 && lexer_is(')');
        index -= depth == 0 && lexer_is(',');
        lexer_next();
    }
}

static bool is_selected(const basic_command_t *row, const char *start) {
    const basic_arg_spec_t *selector = selector_of(row);
    if (selector == NULL) {
        return false;
    }
    go_to_argument(start, (size_t)(selector - row->args));
    return lexer_now()->kind == LEXER_NAME &&
           choices_find(selector->choices, lexer_now()->text, lexer_now()->length) >= 0;
}

static bool has_name(int row, const char *name) {
    return strcmp(rows_command((unsigned)row)->name, name) == 0;
}

// The words of all rows with this name, in the order of the rows, "A, B, C"; dots where the buffer
// ends. Returns the row whose word stands first among the arguments.
static const basic_command_t *list_words(int row, char *buffer, size_t size) {
    const char *name = rows_command((unsigned)row)->name;
    size_t used = 0;
    size_t place = SIZE_MAX;
    const basic_command_t *first = NULL;
    while (row > 0 && has_name(row - 1, name)) {
        row--;
    }
    for (; rows_command((unsigned)row) != NULL && has_name(row, name); row++) {
        const basic_command_t *command = rows_command((unsigned)row);
        size_t index = (size_t)(selector_of(command) - command->args);
        if (index < place) {
            place = index;
            first = command;
        }
        if (used < size - 1) {
            used += used > 0 ? format_text(buffer + used, size - used, "%s", ", ") : 0;
            choices_list(command->args[index].choices, buffer + used, size - used);
            used += strlen(buffer + used);
        }
    }
    if (used + 4 > size) {
        memcpy(buffer + size - 4, "...", 4);
    }
    return first;
}

// Only when each of the rows has an argument that selects it.
static _Noreturn void fail_selection(int row, const char *start) {
    char words[100];
    const basic_command_t *command = list_words(row, words, sizeof words);
    const basic_arg_spec_t *selector = selector_of(command);
    go_to_argument(start, (size_t)(selector - command->args));
    if (lexer_at_end() || lexer_is(',')) {
        errors_fail_with(ERR_ARGUMENTS_MISSING, "%s", selector->name);
    }
    const lexer_token_t *word = lexer_now();
    errors_fail_with(ERR_ARGUMENT, "%s: %.*s is invalid (valid is %s)", selector->name,
                     (int)word->length, word->text, words);
}

int args_select_row(int row, const char *start) {
    const char *name = rows_command((unsigned)row)->name;
    int fallback = WORDS_NONE;
    int first = row;
    for (; row != WORDS_NONE; row = words_next(WORDS_COMMAND, row)) {
        if (!has_name(row, name)) {
            continue;
        }
        if (is_selected(rows_command((unsigned)row), start)) {
            return row;
        }
        if (selector_of(rows_command((unsigned)row)) == NULL) {
            fallback = row;
        }
    }
    if (fallback == WORDS_NONE) {
        fail_selection(first, start);
    }
    return fallback;
}
