// DIM, REDIM, ERASE, CONST, INC, CAT, DATA, READ, RESTORE and REM. Context: main loop, while
// compiling.
#include <string.h>

#include "compiler.h"
#include "declare.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "labels.h"
#include "lexer.h"
#include "names.h"
#include "source_lines.h"
#include "statements.h"
#include "words.h"

void statements_dim(void) {
    declare_compile(DECLARE_DIM);
}

void statements_const(void) {
    do {
        lexer_token_t name = *lexer_now();
        if (name.kind != LEXER_NAME || words_is_reserved(name.text, name.length) ||
            words_find(WORDS_FUNCTION, name.text, name.length) != WORDS_NONE) {
            errors_fail(ERR_SYNTAX);
        }
        lexer_next();
        lexer_expect('=');
        uint8_t type = lexer_suffix_type(name.suffix);
        expressions_compile();
        emit_integer(type);
        emit_integer(names_global(&name, type));
        emit_action(ACTIONS_CONST, 3);
    } while (lexer_take(','));
}

void statements_inc(void) {
    expressions_compile_reference();
    if (lexer_take(',')) {
        expressions_compile();
    } else {
        emit_integer(1);
    }
    emit_action(ACTIONS_INC, 2);
}

static void emit_data(const char *text, size_t length) {
    emit_op(OP_DATA);
    compiler_link_data();
    emit_text(text, length);
}

// Items on several lines that are one: a DATA for each line, without the joints. An item cannot be
// broken.
static void emit_joined_data(const char *text, const char *end) {
    const char *start = text;
    for (const char *p = text; p < end; p++) {
        if (source_lines_is_joint(p, end)) {
            const char *stop = p;
            while (stop > start && (stop[-1] == ' ' || stop[-1] == '\t')) {
                stop--;
            }
            stop -= stop > start && stop[-1] == ','; // it would open another, empty item
            emit_data(start, (size_t)(stop - start));
            p = memchr(p, '\n', (size_t)(end - p));
            start = p + 1;
        }
    }
    emit_data(start, (size_t)(end - start));
}

// The items stay text; READ cuts them.
void statements_data(void) {
    if (compiler_is_loose()) {
        errors_fail(ERR_INVALID_HERE);
    }
    const char *start = lexer_now()->text;
    if (lexer_now()->kind == LEXER_STRING) {
        start--;
    }
    const char *behind = start;
    while (!lexer_at_end()) {
        behind = lexer_now()->behind;
        lexer_next();
    }
    size_t length = (size_t)(behind - start);
    if (memchr(start, '\n', length) != NULL) {
        emit_joined_data(start, behind);
    } else {
        emit_data(start, length);
    }
}

void statements_cat(void) {
    expressions_compile_reference();
    lexer_expect(',');
    expressions_compile();
    emit_action(ACTIONS_CAT, 2);
}

// SAVE and RESTORE keep and bring back the place in the DATA.
void statements_read(void) {
    if (lexer_take_word("SAVE")) {
        emit_action(ACTIONS_READ_SAVE, 0);
        return;
    }
    if (lexer_take_word("RESTORE")) {
        emit_action(ACTIONS_READ_RESTORE, 0);
        return;
    }
    do {
        expressions_compile_reference_or_array();
        emit_action(ACTIONS_READ, 1);
    } while (lexer_take(','));
}

void statements_erase(void) {
    do {
        if (lexer_now()->kind != LEXER_NAME) {
            errors_fail(ERR_SYNTAX);
        }
        uint16_t variable = expressions_compile_name();
        if (variable == CODE_LOCAL_FLAG) { // the FUNCTION's value
            errors_fail(ERR_INVALID_HERE);
        }
        if (lexer_take('(')) {
            lexer_expect(')');
        }
        emit_integer(variable);
        emit_action(ACTIONS_ERASE, 1);
    } while (lexer_take(','));
}

void statements_clear(void) {
    emit_action(ACTIONS_CLEAR, 0);
}

void statements_redim(void) {
    declare_compile_again(lexer_take_word("PRESERVE"));
}

void statements_restore(void) {
    if (lexer_at_end()) {
        emit_action(ACTIONS_RESTORE, 0);
    } else {
        labels_operand();
        emit_action(ACTIONS_RESTORE, 1);
    }
}

void statements_rem(void) {
    lexer_go(lexer_line_end());
}
