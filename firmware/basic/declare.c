// DIM and LOCAL: [type] name[(sizes)] [AS type] [LENGTH n] [= values], ... Context: main loop, while
// compiling.
#include "declare.h"

#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "names.h"
#include "variables.h"
#include "words.h"

static uint8_t take_type(void) {
    if (lexer_take_word("INTEGER")) {
        return VALUE_INTEGER;
    }
    if (lexer_take_word("FLOAT")) {
        return VALUE_FLOAT;
    }
    if (lexer_take_word("STRING")) {
        return VALUE_STRING;
    }
    return VALUE_NONE;
}

uint8_t declare_type_at_hand(void) {
    uint8_t type = take_type();
    if (type == VALUE_NONE) {
        errors_fail(ERR_SYNTAX);
    }
    return type;
}

static uint8_t agreed(uint8_t one, uint8_t other, const lexer_token_t *name) {
    if (one != VALUE_NONE && other != VALUE_NONE && one != other) {
        errors_fail_with(ERR_DIFFERENT_TYPE, "%.*s", (int)lexer_bare_length(name), name->text);
    }
    return one != VALUE_NONE ? one : other;
}

// = value, or = (value, value ...) for an array.
static void compile_values(uint16_t variable, bool is_array) {
    if (!is_array) {
        expressions_compile();
        emit_variable(OP_STORE, variable);
        return;
    }
    unsigned index = 0;
    lexer_expect('(');
    do {
        emit_integer(variable);
        emit_integer(index++);
        expressions_compile();
        emit_action(ACTIONS_FILL, 3);
    } while (lexer_take(','));
    lexer_expect(')');
}

// What ACTIONS_DIM gets: the sizes, the type, the length, the variable.
static void compile_one(bool local, uint8_t list_type) {
    lexer_token_t name = *lexer_now();
    if (name.kind != LEXER_NAME || words_is_reserved(name.text, name.length) ||
        words_find(WORDS_FUNCTION, name.text, name.length) != WORDS_NONE) {
        errors_fail(ERR_SYNTAX);
    }
    uint8_t type = agreed(lexer_suffix_type(name.suffix), list_type, &name);
    lexer_next();
    unsigned dimensions = 0;
    if (lexer_is('(')) {
        dimensions = expressions_compile_subscripts();
        if (dimensions > VARIABLES_DIMENSIONS_MAX) {
            errors_fail(ERR_ARRAY_DIMENSIONS);
        }
    }
    if (lexer_take_word("AS")) {
        type = agreed(type, declare_type_at_hand(), &name);
    }
    uint8_t stated = type != VALUE_NONE ? type : names_default_type();
    if (stated == VALUE_NONE) {
        errors_fail(ERR_NO_TYPE);
    }
    emit_integer(stated);
    if (lexer_take_word("LENGTH")) {
        expressions_compile();
    } else {
        emit_integer(VALUE_STRING_MAX);
    }
    uint16_t variable = local ? names_local(&name, stated) : names_global(&name, type);
    emit_integer(variable);
    emit_action(ACTIONS_DIM, dimensions + 3);
    if (lexer_take('=')) {
        compile_values(variable, dimensions != 0);
    }
}

void declare_compile(bool local) {
    uint8_t list_type = take_type();
    do {
        compile_one(local, list_type);
    } while (lexer_take(','));
}
