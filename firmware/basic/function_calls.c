// Calls of the built-in functions, by the rows of functions_table. Context: main loop, while
// compiling.
#include "function_calls.h"

#include <string.h>

#include "args.h"
#include "base/base.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "functions.h"
#include "lexer.h"
#include "words.h"

#define FAMILY_NAME_SIZE 24 // "MATH(KEYWORD"

// What the `index`th argument has to be, see functions.h.
static char type_of_argument(const functions_row_t *function, unsigned index) {
    size_t count = strlen(function->types);
    if (count == 0) {
        errors_fail(ERR_ARGUMENT_COUNT);
    }
    return function->types[index < count ? index : count - 1];
}

static void compile_keyword(void) {
    if (lexer_now()->kind != LEXER_NAME) {
        errors_fail(ERR_SYNTAX);
    }
    emit_string(lexer_now()->text, lexer_now()->length);
    lexer_next();
}

// A bare word, if it stands alone, means itself.
static void compile_word_argument(void) {
    const lexer_token_t *token = lexer_now();
    const char *start = token->text;
    size_t length = token->length;
    if (token->kind == LEXER_NAME && token->suffix == 0) {
        lexer_next();
        if (lexer_is(',') || lexer_is(')')) {
            emit_string(start, length);
            return;
        }
        lexer_go(start);
    }
    expressions_compile();
}

// GPn may stand bare.
static void compile_pin_argument(void) {
    const lexer_token_t *name = lexer_now();
    if (args_is_pin_name(name)) {
        emit_string(name->text, name->length);
        lexer_next();
    } else {
        expressions_compile();
    }
}

static void compile_argument(char type) {
    switch (type) {
    case 'a':
        expressions_compile_variable(false, true);
        break;
    case 'r':
        expressions_compile_variable(true, false);
        break;
    case 'd':
        expressions_compile_argument();
        break;
    case 'k':
        compile_keyword();
        break;
    case 'w':
        compile_word_argument();
        break;
    case 't':
        if (lexer_take_word("NOW")) {
            emit_op(OP_BLANK);
        } else {
            expressions_compile();
        }
        break;
    case 'p':
        compile_pin_argument();
        break;
    case 'c':
        lexer_take('#');
        expressions_compile();
        break;
    case 'I':
        if (lexer_is(',') || lexer_is(')')) {
            emit_op(OP_BLANK);
            break;
        }
        expressions_compile();
        break;
    default:
        expressions_compile();
        break;
    }
}

static void emit_call(int row, unsigned count) {
    const functions_row_t *function = &functions_table[row];
    if (count < function->least || count > function->most) {
        errors_fail(ERR_ARGUMENT_COUNT);
    }
    emit_op(OP_FUNCTION);
    emit_byte((unsigned)row);
    emit_byte(count);
}

// Arguments up to the closing parenthesis; returns how many.
static unsigned compile_arguments(const functions_row_t *function) {
    unsigned count = 0;
    char type = '\0'; // of the argument before
    expressions_enter(EXPRESSIONS_PARENTHESIS);
    while (!lexer_is(')')) {
        if (count > 0 && type != 'k') {
            lexer_expect(',');
        }
        type = type_of_argument(function, count++);
        compile_argument(type);
    }
    expressions_leave(EXPRESSIONS_PARENTHESIS);
    lexer_expect(')');
    return count;
}

// ---- Special forms ------------------------------------------------------------------------------

// CALL(name$, arguments) and EVAL(text$).
static void compile_indirect(void) {
    bool is_call = lexer_is_word("CALL");
    unsigned count = 0;
    lexer_next();
    lexer_expect('(');
    expressions_enter(EXPRESSIONS_PARENTHESIS);
    expressions_compile();
    if (is_call && lexer_take(',')) {
        count = expressions_compile_arguments(')');
    }
    expressions_leave(EXPRESSIONS_PARENTHESIS);
    lexer_expect(')');
    emit_indirect(is_call ? INDIRECT_FUNCTION : INDIRECT_EVAL, count);
}

// MATH(keyword arguments), MM.INFO(keyword) or MM.INFO$(keyword): the row has the name
// "MATH(KEYWORD", which no program can write otherwise.
static void compile_family(const char *family) {
    lexer_next();
    lexer_expect('(');
    const lexer_token_t *keyword = lexer_now();
    char name[FAMILY_NAME_SIZE];
    size_t length = format_text(name, sizeof name, "%.*s(%.*s", (int)strcspn(family, "$"), family,
                                (int)keyword->length, keyword->text);
    int row = keyword->kind == LEXER_NAME && length < sizeof name
                  ? words_find(WORDS_FUNCTION, name, length)
                  : WORDS_NONE;
    if (row == WORDS_NONE) {
        errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "%s", family);
    }
    lexer_next();
    emit_call(row, compile_arguments(&functions_table[row]));
}

void function_calls_compile(int row) {
    const functions_row_t *function = &functions_table[row];
    if (function->evaluate == NULL) {
        if (function->types[0] == '(') {
            compile_family(function->name);
        } else {
            compile_indirect();
        }
        return;
    }
    unsigned count = 0;
    lexer_next();
    if (function->most > 0 && (function->least > 0 || lexer_is('('))) {
        lexer_expect('(');
        count = compile_arguments(function);
    } else if (function->most == 0 && lexer_take('(')) {
        lexer_expect(')');
    }
    emit_call(row, count);
}
