// Compiles the arguments of the configuration's rows, each as its kind says. Context: main loop,
// while compiling.
#include "args.h"

#include <string.h>

#include "choices.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "names.h"
#include "words.h"

static const basic_config_t *config;

void args_start(const basic_config_t *new_config) {
    config = new_config;
}

const basic_command_t *args_command(unsigned row) {
    return &config->commands[row];
}

const basic_function_t *args_function(unsigned row) {
    return &config->functions[row];
}

// ---- One argument --------------------------------------------------------------------------------

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
    uint8_t check_type;
    emit_variable(OP_WORD, names_variable(name, &check_type));
    emit_byte(only_string);
    emit_text(name->text, name->length);
    lexer_next();
}

static bool is_pin_name(const lexer_token_t *name) {
    return name->length > 2 && lexer_same(name->text, 2, "GP") && name->text[2] >= '0' &&
           name->text[2] <= '9';
}

static void compile_number_token(void) {
    emit_constant(&lexer_now()->value);
    emit_op(OP_LITERAL);
    lexer_next();
}

static void compile_argument(const basic_arg_spec_t *spec, bool in_parentheses) {
    const lexer_token_t *token = lexer_now();
    bool is_name = token->kind == LEXER_NAME;
    bool alone = (is_name || token->kind == LEXER_NUMBER) && stands_alone(in_parentheses);
    if (alone && is_name && token->suffix == 0) {
        if (spec->kind == BASIC_ARG_CHOICE &&
            choices_find(spec->choices, token->text, token->length) < 0) {
            compile_word(false);
            return;
        }
        if (spec->kind == BASIC_ARG_CHOICE || (spec->kind == BASIC_ARG_PIN && is_pin_name(token))) {
            emit_string(token->text, token->length);
            lexer_next();
            return;
        }
        if (spec->kind == BASIC_ARG_WORD) {
            compile_word(true);
            return;
        }
    }
    if (alone && spec->kind == BASIC_ARG_PIN && token->kind == LEXER_NUMBER) {
        compile_number_token();
        return;
    }
    expressions_compile();
}

// The rest of the statement as typed.
static void compile_raw(void) {
    const char *start = lexer_now()->text;
    const char *end = lexer_line_end();
    const char *p = start;
    unsigned depth = 0;
    bool quoted = false;
    for (; p < end; p++) {
        if (*p == '"') {
            quoted = !quoted;
        }
        if (quoted) {
            continue;
        }
        if (depth == 0 && (*p == '\'' || *p == ';')) {
            p = end; // a comment takes the rest, colons and all
            break;
        }
        depth += *p == '(';
        depth -= *p == ')' && depth > 0;
        bool word_start = p == start || !lexer_is_name_part(p[-1]);
        bool is_else = lexer_else_ends() && word_start && end - p >= 4 &&
                       lexer_same(p, 4, "ELSE") && (end - p == 4 || !lexer_is_name_part(p[4]));
        if (depth == 0 && (*p == ':' || is_else)) {
            break;
        }
    }
    size_t length = (size_t)(p - start);
    while (length > 0 && (start[length - 1] == ' ' || start[length - 1] == '\t')) {
        length--;
    }
    emit_string(start, length);
    lexer_go(p);
}

// ---- The list ------------------------------------------------------------------------------------

static const basic_arg_spec_t *spec_of(const basic_arg_spec_t *specs, size_t count, size_t index) {
    if (index < count) {
        return &specs[index];
    }
    for (size_t i = 0; i < count; i++) {
        if (specs[i].flags & BASIC_ARG_REPEAT) {
            return &specs[i + (index - i) % (count - i)];
        }
    }
    return NULL;
}

static bool list_ends(bool in_parentheses) {
    return in_parentheses ? lexer_is(')') : lexer_at_end();
}

static unsigned compile_list(const basic_arg_spec_t *specs, size_t spec_count,
                             bool in_parentheses) {
    unsigned count = 0;
    // RAW also takes an apostrophe or nothing at all, where other lists are at their end.
    bool ends = list_ends(in_parentheses) && !(spec_count == 1 && specs[0].kind == BASIC_ARG_RAW);
    for (bool more = !ends; more; more = lexer_take(',')) {
        const basic_arg_spec_t *spec = spec_of(specs, spec_count, count);
        if (spec == NULL || count == BASIC_ARGS_MAX) {
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

// ---- Names of several words ----------------------------------------------------------------------

// How many characters of source the row's name takes at the token at hand; 0: it is another name.
static const char *match_name(const char *name, const char *text) {
    const char *end = lexer_line_end();
    while (*name != '\0') {
        size_t length = strcspn(name, " ");
        while (text < end && (*text == ' ' || *text == '\t')) {
            text++;
        }
        size_t available = (size_t)(end - text);
        if (available < length) {
            return NULL;
        }
        for (size_t i = 0; i < length; i++) {
            char c = text[i] >= 'a' && text[i] <= 'z' ? (char)(text[i] - 0x20) : text[i];
            char wanted = name[i] >= 'a' && name[i] <= 'z' ? (char)(name[i] - 0x20) : name[i];
            if (c != wanted) {
                return NULL;
            }
        }
        if (available > length && lexer_is_name_part(text[length])) {
            return NULL;
        }
        text += length;
        name += length + (name[length] == ' ');
    }
    return text;
}

void args_compile_command(int row) {
    const char *start = lexer_now()->text;
    const char *first_name = config->commands[row].name;
    const char *behind = NULL;
    size_t longest = 0;
    int found = WORDS_NONE;
    for (; row != WORDS_NONE; row = words_next(WORDS_COMMAND, row)) {
        const char *name = config->commands[row].name;
        const char *end = strlen(name) > longest ? match_name(name, start) : NULL;
        if (end != NULL) {
            longest = strlen(name);
            found = row;
            behind = end;
        }
    }
    if (found == WORDS_NONE) {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "%.*s", (int)strcspn(first_name, " "), first_name);
    }
    const basic_command_t *command = &config->commands[found];
    lexer_go(behind);
    unsigned count = compile_list(command->args, command->arg_count, false);
    emit_op(OP_COMMAND);
    emit_byte((unsigned)found);
    emit_byte(count);
}

void args_compile_function(int row) {
    const char *name = config->functions[row].name;
    lexer_next();
    bool parentheses = lexer_take('(');
    int found = WORDS_NONE;
    for (; row != WORDS_NONE; row = words_next(WORDS_HOST_FUNCTION, row)) {
        const char *keyword = config->functions[row].keyword;
        if (keyword != NULL && lexer_is_word(keyword)) {
            found = row;
            lexer_next();
            break;
        }
        if (keyword == NULL) {
            found = row;
        }
    }
    if (found == WORDS_NONE) {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "%s", name);
    }
    const basic_function_t *function = &config->functions[found];
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
    emit_byte((unsigned)found);
    emit_byte(count);
}
