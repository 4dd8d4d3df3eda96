// What a word that has been begun may become. Context: main loop.
#include "complete.h"

#include <string.h>

#include "base/base.h"
#include "console.h"
#include "files/files.h"
#include "functions.h"
#include "lexer.h"
#include "rows.h"
#include "statements.h"
#include "symbols.h"

typedef void (*visit_t)(const char *name, size_t length, char after);

// The word at hand and where what is found goes.
static struct {
    const char *line;
    size_t cursor;
    size_t statement; // where the statement starts
    size_t word;      // where the last word starts, or the name of a file
    bool in_string;
    bool lower; // typed in small letters
    visit_t visit;
    complete_t *result;
} at;

// ---- Where the word is --------------------------------------------------------------------------

static bool is_word(const char *text, size_t length, const char *word) {
    return length == strlen(word) && lexer_same(text, length, word);
}

// A word behind which a statement begins, or (HELP) its name stands.
static bool opens_statement(const char *text, size_t length) {
    return is_word(text, length, "THEN") || is_word(text, length, "ELSE") ||
           is_word(text, length, "HELP");
}

static size_t skip_blanks(size_t place) {
    while (place < at.cursor && at.line[place] == ' ') {
        place++;
    }
    return place;
}

static void find_word(void) {
    size_t i = at.statement = at.word = skip_blanks(0);
    at.in_string = false;
    while (i < at.cursor) {
        char c = at.line[i];
        if (c == '"') {
            at.in_string = !at.in_string;
            at.word = ++i;
        } else if (at.in_string) {
            i++;
        } else if (lexer_is_name_start(c)) {
            at.word = i;
            while (i < at.cursor && lexer_is_name_part(at.line[i])) {
                i++;
            }
            if (i < at.cursor && opens_statement(at.line + at.word, i - at.word)) {
                at.statement = skip_blanks(i);
            }
        } else {
            i++;
            at.word = i;
            at.statement = c == ':' ? skip_blanks(i) : at.statement;
        }
    }
    char last = at.cursor > 0 ? at.line[at.cursor - 1] : '\0';
    at.lower = last >= 'a' && last <= 'z';
}

// ---- Candidates ---------------------------------------------------------------------------------

// Visits the name if it begins with what was typed from `start` on.
static void offer(size_t start, const char *name, size_t length, char after) {
    size_t typed = at.cursor - start;
    if (typed > length) {
        return;
    }
    for (size_t i = 0; i < typed; i++) {
        bool same = at.in_string ? name[i] == at.line[start + i]
                                 : letters_upper(name[i]) == letters_upper(at.line[start + i]);
        if (!same) {
            return;
        }
    }
    at.result->typed = typed;
    at.visit(name, length, after);
}

static void offer_symbol(symbols_t *symbol) {
    bool is_sub = symbol->kind == SYMBOLS_ROUTINE && !symbol->routine->is_function;
    bool at_start = at.word == at.statement;
    if (symbol->kind == SYMBOLS_LABEL || symbol->scope != 0 || (is_sub && !at_start)) {
        return;
    }
    bool is_function = symbol->kind == SYMBOLS_ROUTINE && !is_sub;
    offer(at.word, symbol->name, symbol->length, is_function ? '(' : is_sub ? ' ' : '\0');
}

static void offer_statements(void) {
    const basic_command_t *row;
    for (unsigned i = 0; (row = rows_command(i)) != NULL; i++) {
        offer(at.statement, row->name, strlen(row->name), ' ');
    }
    for (size_t i = 0; at.word == at.statement && i < statements_count; i++) {
        const char *name = statements_table[i].name;
        bool repeated = i > 0 && strcmp(name, statements_table[i - 1].name) == 0;
        if (statements_table[i].usage != NULL && !repeated) {
            offer(at.word, name, strlen(name), ' ');
        }
    }
}

// A function of several rows, such as PEEK, is one candidate.
static bool is_first_of_its_name(unsigned row) {
    for (unsigned i = 0; i < row; i++) {
        if (strcmp(rows_function(i)->name, rows_function(row)->name) == 0) {
            return false;
        }
    }
    return true;
}

static void offer_functions(void) {
    const basic_function_t *row;
    for (unsigned i = 0; (row = rows_function(i)) != NULL; i++) {
        if (is_first_of_its_name(i)) {
            offer(at.word, row->name, strlen(row->name), '(');
        }
    }
    for (size_t i = 0; i < functions_count; i++) {
        const char *name = functions_table[i].name;
        offer(at.word, name, strlen(name), functions_table[i].most > 0 ? '(' : '\0');
    }
}

// The name of a file: what stands in front of its last slash is a folder.
static void offer_files(void) {
    char folder[FILES_PATH_MAX + 1];
    size_t name = at.cursor;
    while (name > at.word && at.line[name - 1] != '/' && at.line[name - 1] != ':') {
        name--;
    }
    size_t length = name - at.word;
    if (length >= sizeof folder) {
        return;
    }
    memcpy(folder, at.line + at.word, length);
    folder[length] = '\0';
    files_entry_t entry;
    if (files_list_start(length == 0 ? "." : folder) != ERR_OK) {
        return;
    }
    while (files_list_next(&entry)) {
        offer(name, entry.name, strlen(entry.name), entry.is_folder ? '/' : '\0');
    }
}

static void each_candidate(const char *line, size_t cursor, complete_t *result, visit_t visit) {
    at.line = line;
    at.cursor = cursor;
    at.result = result;
    at.visit = visit;
    *result = (complete_t){0};
    find_word();
    if (at.in_string) {
        offer_files();
        return;
    }
    if (at.statement < at.cursor) {
        offer_statements();
    }
    if (at.word < at.cursor) {
        offer_functions();
        symbols_each(offer_symbol);
    }
}

// ---- What comes of them -------------------------------------------------------------------------

static char as_typed(char c) {
    return at.in_string ? c : at.lower ? letters_lower(c) : letters_upper(c);
}

// Keeps what all candidates have in common.
static void take(const char *name, size_t length, char after) {
    complete_t *result = at.result;
    const char *rest = name + result->typed;
    size_t rest_length = length - result->typed;
    if (result->count++ == 0) {
        rest_length = rest_length < COMPLETE_MAX - 1 ? rest_length : COMPLETE_MAX - 1;
        for (size_t i = 0; i < rest_length; i++) {
            result->more[i] = as_typed(rest[i]);
        }
        result->more[rest_length] = after;
        result->more_length = rest_length + (after != '\0');
        return;
    }
    size_t same = 0;
    while (same < result->more_length && same < rest_length &&
           result->more[same] == as_typed(rest[same])) {
        same++;
    }
    result->more_length = same;
}

void complete_find(const char *line, size_t cursor, complete_t *result) {
    each_candidate(line, cursor, result, take);
}

static void print_name(const char *name, size_t length, char after) {
    if (console_column() + length + 2 > console_columns() - 2) {
        console_new_line();
    }
    console_print(console_column() == 0 ? "" : "  ");
    console_write(name, length);
    if (after == '(' || after == '/') {
        console_write(&after, 1);
    }
}

void complete_list(const char *line, size_t cursor) {
    complete_t result;
    each_candidate(line, cursor, &result, print_name);
    console_fresh_line();
}
