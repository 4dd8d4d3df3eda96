// PRINT, INPUT, LINE INPUT. Context: main loop, while compiling.
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"

static void compile_print_item(void) {
    if (lexer_take_word("TAB")) {
        if (expressions_compile_subscripts() != 1) {
            errors_fail(ERR_ARGUMENT_COUNT);
        }
        emit_action(ACTIONS_PRINT_TAB, 1);
    } else if (lexer_take('@')) {
        if (expressions_compile_subscripts() != 2) {
            errors_fail(ERR_ARGUMENT_COUNT);
        }
        emit_action(ACTIONS_PRINT_AT, 2);
    } else {
        expressions_compile();
        emit_action(ACTIONS_PRINT_VALUE, 1);
    }
}

void statements_cls(void) {
    emit_action(ACTIONS_CLS, 0);
}

void statements_print(void) {
    if (lexer_take('#')) {
        statements_print_channel();
        return;
    }
    bool line_open = false; // a separator at the end keeps the line open
    while (!lexer_at_end()) {
        if (lexer_take(';')) {
            line_open = true;
        } else if (lexer_take(',')) {
            emit_action(ACTIONS_PRINT_COMMA, 0);
            line_open = true;
        } else {
            compile_print_item();
            line_open = false;
        }
    }
    if (!line_open) {
        emit_action(ACTIONS_PRINT_LINE, 0);
    }
}

// ["prompt" ;|,] - a comma behind the prompt leaves the question mark out.
static void compile_prompt(void) {
    if (lexer_now()->kind == LEXER_STRING) {
        expressions_compile_text();
        bool question = lexer_take(';');
        if (!question) {
            lexer_expect(',');
        }
        emit_integer(question);
    } else {
        emit_string("", 0);
        emit_integer(1);
    }
    emit_action(ACTIONS_INPUT_LINE, 2);
}

void statements_input(void) {
    if (lexer_take('#')) {
        statements_input_channel();
    } else {
        compile_prompt();
    }
    do {
        expressions_compile_reference();
        emit_action(ACTIONS_INPUT_FIELD, 1);
    } while (lexer_take(','));
}

// True if a comma follows at this level: then what comes first is the prompt.
static bool has_prompt(void) {
    const char *start = lexer_now()->text - (lexer_now()->kind == LEXER_STRING);
    int depth = 0;
    bool found = false;
    while (!lexer_at_end() && !found) {
        depth += lexer_is('(');
        depth -= lexer_is(')');
        found = depth == 0 && lexer_is(',');
        lexer_next();
    }
    lexer_go(start);
    return found;
}

void statements_line(void) {
    lexer_expect_word("INPUT");
    if (lexer_take('#')) {
        statements_line_input_channel();
        return;
    }
    if (has_prompt()) {
        expressions_compile();
        lexer_expect(',');
    } else {
        emit_string("", 0);
    }
    expressions_compile_reference();
    emit_action(ACTIONS_LINE_INPUT, 2);
}
