// Compiles the arguments of the configuration's rows, each as its kind says. Context: main loop,
// while compiling.
#include "args.h"

#include <string.h>

#include "args_select.h"
#include "choices.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "names.h"
#include "rows.h"
#include "symbols.h"
#include "words.h"

#define VALUES_MAX 255u // of a command, as its code counts them

// ---- One argument -------------------------------------------------------------------------------

// True if the token at hand stands alone between commas (or is the last argument).
static bool stands_alone(bool in_parentheses) {
    const char *start = lexer_now()->text;
    lexer_next();
    bool alone = lexer_is(',') || lexer_at_end() || (in_parentheses && lexer_is(')'));
    lexer_go(start);
    return alone;
}

static void compile_word(bool only_string) {
    const lexer_token_t *name = lexer_now();
    if (symbols_find(SYMBOLS_ROUTINE, 0, name->text, name->length) != NULL) {
        emit_string(name->text, name->length); // the name of a SUB is no variable's
        lexer_next();
        return;
    }
    uint8_t check_type;
    emit_variable(OP_WORD, names_variable(name, &check_type));
    emit_byte(only_string);
    emit_text(name->text, name->length);
    lexer_next();
}

// The name of a SUB, or of a string variable that holds one.
static void compile_routine_name(void) {
    const lexer_token_t *name = lexer_now();
    if (symbols_find(SYMBOLS_ROUTINE, 0, name->text, name->length) != NULL) {
        emit_string(name->text, name->length);
        lexer_next();
    } else {
        compile_word(true);
    }
}

bool args_is_pin_name(const lexer_token_t *name) {
    return name->kind == LEXER_NAME && name->suffix == 0 && name->length > 2 &&
           lexer_same(name->text, 2, "GP") && name->text[2] >= '0' && name->text[2] <= '9';
}

static void compile_number_token(void) {
    emit_constant(&lexer_now()->value);
    emit_op(OP_LITERAL);
    lexer_next();
}

static bool is_number(const basic_arg_spec_t *spec) {
    return spec->kind == BASIC_ARG_NUMBER || spec->kind == BASIC_ARG_INTEGER;
}

// OFF and ON where 0 or 1 is asked for. As names of variables both would be 0.
static bool compile_switch(const basic_arg_spec_t *spec, bool in_parentheses) {
    bool is_switch = spec->kind == BASIC_ARG_INTEGER && spec->min == 0.0 && spec->max == 1.0;
    bool is_on = lexer_is_word("ON");
    if (!is_switch || !(is_on || lexer_is_word("OFF")) || !stands_alone(in_parentheses)) {
        return false;
    }
    emit_integer(is_on);
    lexer_next();
    return true;
}

static void compile_argument(const basic_arg_spec_t *spec, bool in_parentheses) {
    const lexer_token_t *token = lexer_now();
    if (is_number(spec) && choices_find(spec->choices, token->text, token->length) >= 0 &&
        stands_alone(in_parentheses)) {
        emit_string(token->text, token->length);
        lexer_next();
        return;
    }
    if (compile_switch(spec, in_parentheses)) {
        return;
    }
    if (spec->kind == BASIC_ARG_DATA) {
        expressions_compile_argument();
        return;
    }
    if (spec->kind == BASIC_ARG_STORE) {
        expressions_compile_reference_or_array();
        return;
    }
    bool is_name = token->kind == LEXER_NAME;
    bool alone = (is_name || token->kind == LEXER_NUMBER) && stands_alone(in_parentheses);
    if (alone && is_name && token->suffix == 0) {
        if (spec->kind == BASIC_ARG_CHOICE &&
            choices_find(spec->choices, token->text, token->length) < 0) {
            compile_word(false);
            return;
        }
        if (spec->kind == BASIC_ARG_CHOICE ||
            (spec->kind == BASIC_ARG_PIN && args_is_pin_name(token))) {
            emit_string(token->text, token->length);
            lexer_next();
            return;
        }
        if (spec->kind == BASIC_ARG_WORD) {
            compile_word(true);
            return;
        }
        if (spec->kind == BASIC_ARG_ROUTINE) {
            compile_routine_name();
            return;
        }
    }
    if (alone && spec->kind == BASIC_ARG_PIN && token->kind == LEXER_NUMBER) {
        compile_number_token();
        return;
    }
    expressions_compile();
}

void args_compile_routine(void) {
    static const basic_arg_spec_t spec = {.name = "sub", .kind = BASIC_ARG_ROUTINE};
    compile_argument(&spec, false);
}

// True if the word ELSE starts at `p`.
static bool is_else(const char *start, const char *p, const char *end) {
    return (*p | 0x20) == 'e' && end - p >= 4 && lexer_same(p, 4, "ELSE") &&
           (end - p == 4 || !lexer_is_name_part(p[4])) &&
           (p == start || !lexer_is_name_part(p[-1]));
}

// Where a raw argument ends: at a colon outside quotes, parentheses and comments.
static const char *raw_end(const char *start, const char *end) {
    unsigned depth = 0;
    bool quoted = false;
    bool else_ends = lexer_else_ends();
    for (const char *p = start; p < end; p++) {
        if (*p == '"') {
            quoted = !quoted;
        } else if (quoted) {
            continue;
        } else if (*p == '(') {
            depth++;
        } else if (*p == ')') {
            depth -= depth > 0;
        } else if (depth != 0) {
            continue;
        } else if (*p == '\'' || *p == ';') {
            return end; // a comment takes the rest, colons and all
        } else if (*p == ':' || (else_ends && is_else(start, p, end))) {
            return p;
        }
    }
    return end;
}

// The rest of the statement as typed.
static void compile_raw(void) {
    const char *start = lexer_now()->text;
    const char *end = raw_end(start, lexer_line_end());
    size_t length = (size_t)(end - start);
    while (length > 0 && (start[length - 1] == ' ' || start[length - 1] == '\t')) {
        length--;
    }
    emit_string(start, length);
    lexer_go(end);
}

// ---- The list -----------------------------------------------------------------------------------

bool args_takes_data(const basic_arg_spec_t *specs, size_t count) {
    return count > 0 && specs[count - 1].kind == BASIC_ARG_DATA;
}

static const basic_arg_spec_t *spec_of(const basic_arg_spec_t *specs, size_t count, size_t index) {
    if (index < count) {
        return &specs[index];
    }
    for (size_t i = 0; i < count; i++) {
        if (specs[i].flags & BASIC_ARG_REPEAT) {
            return &specs[i + (index - i) % (count - i)];
        }
    }
    return args_takes_data(specs, count) ? &specs[count - 1] : NULL;
}

static bool list_ends(bool in_parentheses) {
    return in_parentheses ? lexer_is(')') : lexer_at_end();
}

static unsigned compile_list(const basic_arg_spec_t *specs, size_t spec_count,
                             bool in_parentheses) {
    unsigned count = 0;
    // RAW also takes an apostrophe or nothing at all, where other lists are at their end.
    unsigned most = args_takes_data(specs, spec_count) ? VALUES_MAX : BASIC_ARGS_MAX;
    bool ends = list_ends(in_parentheses) && !(spec_count == 1 && specs[0].kind == BASIC_ARG_RAW);
    for (bool more = !ends; more; more = lexer_take(',')) {
        const basic_arg_spec_t *spec = spec_of(specs, spec_count, count);
        if (spec == NULL || count == most) {
            errors_fail(ERR_ARGUMENTS_TOO_MANY);
        }
        if (spec->kind == BASIC_ARG_RAW) {
            compile_raw();
        } else if (lexer_is(',') || list_ends(in_parentheses)) {
            emit_op(OP_BLANK);
        } else {
            compile_argument(spec, in_parentheses);
        }
        count++;
    }
    if (!list_ends(in_parentheses)) {
        errors_fail(ERR_SYNTAX);
    }
    return count;
}

// ---- Names of several words ---------------------------------------------------------------------

static const char *skip_blanks(const char *text, const char *end) {
    while (text < end && (*text == ' ' || *text == '\t')) {
        text++;
    }
    return text;
}

// Compares the words of `name` with the source from `text` on. Returns the place behind them, NULL
// if they are not there.
static const char *match_words(const char *name, const char *text) {
    const char *end = lexer_line_end();
    for (text = skip_blanks(text, end); *name != '\0'; name++) {
        if (*name == ' ') {
            const char *next = skip_blanks(text, end);
            if (next == text) {
                return NULL;
            }
            text = next;
        } else if (text < end && letters_upper(*text) == letters_upper(*name)) {
            text++;
        } else {
            return NULL;
        }
    }
    return text < end && lexer_is_name_part(*text) ? NULL : text;
}

// All rows of the chain start with the word at hand: only what is behind it has to be compared.
// WORDS_NONE: none fits; otherwise `behind` is where its words end.
static int find_command(int row, const char **behind) {
    size_t first_length = strcspn(rows_command((unsigned)row)->name, " ");
    const char *start = lexer_now()->behind;
    size_t longest = 0;
    int found = WORDS_NONE;
    for (; row != WORDS_NONE; row = words_next(WORDS_COMMAND, row)) {
        const char *rest = rows_command((unsigned)row)->name + first_length;
        const char *end = *rest == '\0' ? start : match_words(rest + 1, start);
        if (end != NULL && (found == WORDS_NONE || strlen(rest) > longest)) {
            longest = strlen(rest);
            found = row;
            *behind = end;
        }
    }
    return found;
}

// A word that stands where the arguments of a row of one word begin, but as no argument can:
// nothing behind it, or something other than an operator. It was meant as a word of a longer name.
static bool is_unknown_word(const basic_command_t *command, int chain) {
    const lexer_token_t word = *lexer_now();
    bool one_word = strchr(command->name, ' ') == NULL;
    bool has_longer = one_word && words_next(WORDS_COMMAND, chain) != WORDS_NONE;
    if (!has_longer || word.kind != LEXER_NAME || word.suffix != 0 || args_is_pin_name(&word)) {
        return false;
    }
    lexer_next();
    const lexer_token_t *next = lexer_now();
    bool needs_more = command->arg_count > 1 &&
                      !(command->args[1].flags & (BASIC_ARG_OPTIONAL | BASIC_ARG_REPEAT));
    bool unknown = next->kind == LEXER_NAME || next->kind == LEXER_NUMBER ||
                   next->kind == LEXER_STRING || (lexer_at_end() && needs_more);
    lexer_go(word.text);
    return unknown;
}

bool args_fits_command(int row) {
    const char *start = lexer_now()->text;
    const char *behind;
    bool found = find_command(row, &behind) != WORDS_NONE;
    lexer_go(start);
    return found;
}

void args_compile_command(int row) {
    const char *first_name = rows_command((unsigned)row)->name;
    const char *behind;
    int found = find_command(row, &behind);
    if (found == WORDS_NONE) {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "%.*s", (int)strcspn(first_name, " "), first_name);
    }
    found = args_select_row(found, behind);
    const basic_command_t *command = rows_command((unsigned)found);
    lexer_go(behind);
    if (is_unknown_word(command, row)) {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "%s", command->name);
    }
    unsigned count = compile_list(command->args, command->arg_count, false);
    emit_op(OP_COMMAND);
    rows_emit(ROWS_COMMANDS, (unsigned)found);
    emit_byte(count);
}

// The same for functions, whose words stand in the parentheses and may be none.
static int find_function(int row, const char **behind) {
    const char *start = lexer_now()->text;
    size_t longest = 0;
    int found = WORDS_NONE;
    for (; row != WORDS_NONE; row = words_next(WORDS_HOST_FUNCTION, row)) {
        const char *keyword = rows_function((unsigned)row)->keyword;
        const char *end = keyword == NULL ? start : match_words(keyword, start);
        size_t length = keyword == NULL ? 0 : strlen(keyword);
        if (end != NULL && (found == WORDS_NONE || length > longest)) {
            longest = length;
            found = row;
            *behind = end;
        }
    }
    return found;
}

void args_compile_function(int row) {
    const char *name = rows_function((unsigned)row)->name;
    lexer_next();
    bool parentheses = lexer_take('(');
    const char *behind;
    int found = find_function(row, &behind);
    if (found == WORDS_NONE) {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "%s", name);
    }
    const basic_function_t *function = rows_function((unsigned)found);
    if (function->keyword != NULL) {
        lexer_go(behind);
    }
    if (!parentheses && function->arg_count > 0) {
        errors_fail(ERR_SYNTAX);
    }
    unsigned count = 0;
    if (parentheses) {
        bool else_ends = lexer_set_else_ends(false);
        count = compile_list(function->args, function->arg_count, true);
        lexer_set_else_ends(else_ends);
        lexer_expect(')');
    }
    emit_op(OP_HOST_FUNCTION);
    rows_emit(ROWS_FUNCTIONS, (unsigned)found);
    emit_byte(count);
}

void args_compile_assignment(int row) {
    const basic_assignment_t *assignment = rows_assignment((unsigned)row);
    lexer_next();
    lexer_expect('(');
    bool else_ends = lexer_set_else_ends(false);
    unsigned count = compile_list(assignment->args + 1, assignment->arg_count - 1, true);
    lexer_set_else_ends(else_ends);
    lexer_expect(')');
    lexer_expect('=');
    compile_argument(&assignment->args[0], false);
    emit_op(OP_ASSIGNMENT);
    rows_emit(ROWS_ASSIGNMENTS, (unsigned)row);
    emit_byte(count + 1);
}
