// Statements about the program, its time and its options. Context: main loop, while compiling.
#include "actions.h"
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "names.h"
#include "options.h"
#include "statements.h"

void statements_pause(void) {
    expressions_compile();
    emit_op(OP_DEADLINE);
    emit_op(OP_WAIT);
}

void statements_timer(void) {
    lexer_expect('=');
    expressions_compile();
    emit_action(ACTIONS_TIMER, 1);
}

static void compile_optional(actions_t action) {
    bool given = !lexer_at_end();
    if (given) {
        expressions_compile();
    }
    emit_action(action, given);
}

void statements_randomize(void) {
    compile_optional(ACTIONS_RANDOMIZE);
}

void statements_error(void) {
    compile_optional(ACTIONS_ERROR);
}

// Deleting or replacing the program while it runs would saw off the branch it sits on.
static void at_prompt_only(void) {
    if (!compiler_at_prompt()) {
        errors_fail(ERR_NOT_IN_PROGRAM);
    }
}

void statements_autosave(void) {
    at_prompt_only();
    emit_integer(lexer_take_word("APPEND"));
    emit_action(ACTIONS_AUTOSAVE, 1);
}

void statements_edit(void) {
    at_prompt_only();
    compile_optional(ACTIONS_EDIT);
}

static int64_t take_line_number(int64_t fallback) {
    const lexer_token_t *token = lexer_now();
    if (token->kind != LEXER_NUMBER || token->value.type != VALUE_INTEGER) {
        return fallback;
    }
    int64_t number = token->value.integer;
    lexer_next();
    return number;
}

// LIST 10-20, LIST 10-, LIST -20, LIST 10
static void compile_list_lines(bool all) {
    int64_t first = take_line_number(1);
    bool range = lexer_take('-');
    int64_t last = range ? take_line_number(INT64_MAX) : first;
    emit_integer(all);
    emit_integer(first);
    emit_integer(last);
    emit_action(ACTIONS_LIST, 3);
}

void statements_list(void) {
    bool all = lexer_take_word("ALL");
    bool commands = lexer_take_word("COMMANDS");
    if (commands || lexer_take_word("FUNCTIONS")) {
        emit_integer(commands);
        emit_action(ACTIONS_LIST_WORDS, 1);
    } else if (lexer_take_word("PINS")) {
        emit_integer(all);
        emit_action(ACTIONS_LIST_PINS, 1);
    } else if (lexer_at_end()) {
        emit_integer(all);
        emit_action(ACTIONS_LIST, 1);
    } else if (lexer_now()->kind == LEXER_NUMBER || lexer_is('-')) {
        compile_list_lines(all);
    } else {
        expressions_compile();
        emit_integer(all);
        emit_action(ACTIONS_LIST_FILE, 2);
    }
}

void statements_memory(void) {
    emit_action(ACTIONS_MEMORY, 0);
}

void statements_help(void) {
    const char *start = lexer_now()->text;
    while (!lexer_at_end()) {
        lexer_next();
    }
    const char *end = lexer_now()->text;
    while (end > start && end[-1] == ' ') {
        end--;
    }
    emit_string(start, (size_t)(end - start));
    emit_action(ACTIONS_HELP, 1);
}

static void emit_option(int option, int64_t value) {
    emit_integer(option);
    emit_integer(value);
    emit_action(ACTIONS_OPTION, 2);
}

static void compile_default_type(void) {
    static const struct {
        const char *word;
        uint8_t type;
    } types[] = {
        {"FLOAT", VALUE_FLOAT},
        {"INTEGER", VALUE_INTEGER},
        {"STRING", VALUE_STRING},
        {"NONE", VALUE_NONE},
    };
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (lexer_take_word(types[i].word)) {
            names_set_default_type(types[i].type);
            emit_option(ACTIONS_OPTION_DEFAULT, types[i].type);
            return;
        }
    }
    errors_fail(ERR_SYNTAX);
}

// ON|ENABLE or nothing: true; OFF|DISABLE: false.
static bool take_switch(void) {
    if (lexer_take_word("OFF") || lexer_take_word("DISABLE")) {
        return false;
    }
    if (!lexer_take_word("ON")) {
        lexer_take_word("ENABLE");
    }
    return true;
}

// How the text of a program is read. False: it is another option.
static bool compile_text_option(void) {
    if (lexer_take_word("ESCAPE")) {
        bool on = take_switch();
        lexer_set_escapes(on);
        emit_option(ACTIONS_OPTION_ESCAPE, on);
        return true;
    }
    if (lexer_take_word("CONTINUATION")) { // in a program source_lines.c has obeyed already
        lexer_expect_word("LINES");
        bool on = take_switch();
        if (compiler_at_prompt()) { // for programs that do not say it
            emit_integer(OPTIONS_CONTINUATION);
            emit_integer(on);
            emit_action(ACTIONS_OPTION_KEEP, 2);
        }
        return true;
    }
    return false;
}

static void compile_angle(void) {
    bool degrees = lexer_take_word("DEGREES");
    if (!degrees) {
        lexer_expect_word("RADIANS");
    }
    emit_option(ACTIONS_OPTION_ANGLE, degrees);
}

void statements_option(void) {
    if (compile_text_option() || statements_option_kept()) {
        return;
    }
    if (lexer_take_word("EXPLICIT")) {
        emit_option(ACTIONS_OPTION_EXPLICIT, take_switch());
    } else if (lexer_take_word("ANGLE")) {
        compile_angle();
    } else if (lexer_take_word("DEFAULT")) {
        compile_default_type();
    } else if (lexer_take_word("BASE")) {
        emit_integer(ACTIONS_OPTION_BASE);
        expressions_compile();
        emit_action(ACTIONS_OPTION, 2);
    } else {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "OPTION");
    }
}

void statements_on_error(void) {
    static const struct {
        const char *word;
        int mode;
    } modes[] = {
        {"ABORT", ACTIONS_ERROR_ABORT},
        {"IGNORE", ACTIONS_ERROR_IGNORE},
        {"SKIP", ACTIONS_ERROR_SKIP},
        {"CLEAR", ACTIONS_ERROR_CLEAR},
    };
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        if (lexer_take_word(modes[i].word)) {
            emit_integer(modes[i].mode);
            if (modes[i].mode == ACTIONS_ERROR_SKIP && !lexer_at_end()) {
                expressions_compile();
            } else {
                emit_integer(1);
            }
            emit_action(ACTIONS_ON_ERROR, 2);
            return;
        }
    }
    errors_fail(ERR_SYNTAX);
}
