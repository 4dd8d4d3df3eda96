// DIM, LOCAL, STATIC: [type] name[(sizes)] [AS type] [LENGTH n] [= values], ... Context: main loop,
// while compiling.
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

// `(sizes)` if they are there, and AS type. Returns how many sizes there are.
static unsigned compile_sizes(const lexer_token_t *name, uint8_t list_type, uint8_t *said) {
    unsigned dimensions = 0;
    *said = agreed(lexer_suffix_type(name->suffix), list_type, name);
    if (lexer_is('(')) {
        dimensions = expressions_compile_subscripts();
        if (dimensions > VARIABLES_DIMENSIONS_MAX) {
            errors_fail(ERR_ARRAY_DIMENSIONS);
        }
    }
    if (lexer_take_word("AS")) {
        *said = agreed(*said, declare_type_at_hand(), name);
    }
    return dimensions;
}

static void compile_length(int64_t otherwise) {
    if (lexer_take_word("LENGTH")) {
        expressions_compile_before_equals();
    } else {
        emit_integer(otherwise);
    }
}

// The sizes, the type and the length, as ACTIONS_DIM gets them.
static unsigned compile_shape(const lexer_token_t *name, uint8_t list_type, uint8_t *said,
                              uint8_t *type) {
    unsigned dimensions = compile_sizes(name, list_type, said);
    *type = *said != VALUE_NONE ? *said : names_default_type();
    if (*type == VALUE_NONE) {
        errors_fail(ERR_NO_TYPE);
    }
    emit_integer(*type);
    compile_length(VALUE_STRING_MAX);
    return dimensions;
}

static void compile_one(declare_kind_t kind, uint8_t list_type) {
    lexer_token_t name = *lexer_now();
    if (name.kind != LEXER_NAME || words_is_reserved(name.text, name.length) ||
        words_find(WORDS_FUNCTION, name.text, name.length) != WORDS_NONE) {
        errors_fail(ERR_SYNTAX);
    }
    lexer_next();
    uint16_t variable = 0;
    uint32_t known = 0;
    if (kind == DECLARE_STATIC) { // the second time there is nothing to do
        variable = names_static(&name);
        emit_variable(OP_KNOWN, variable);
        emit_jump(OP_JUMP_TRUE, &known);
    }
    uint8_t said, type;
    unsigned dimensions = compile_shape(&name, list_type, &said, &type);
    if (kind == DECLARE_STATIC) {
        names_set_static_type(variable, type);
    } else {
        variable = kind == DECLARE_LOCAL ? names_local(&name, type) : names_global(&name, said);
    }
    emit_integer(variable);
    emit_action(ACTIONS_DIM, dimensions + 3);
    if (lexer_take('=')) {
        compile_values(variable, dimensions != 0);
    }
    emit_patch(&known);
}

void declare_compile(declare_kind_t kind) {
    uint8_t list_type = take_type();
    do {
        compile_one(kind, list_type);
    } while (lexer_take(','));
}

// What ACTIONS_REDIM gets: the sizes, the type or VALUE_NONE, the length or 0, the variable,
// PRESERVE.
static void compile_one_again(uint8_t list_type, bool preserve) {
    lexer_token_t name = *lexer_now();
    if (name.kind != LEXER_NAME || words_is_reserved(name.text, name.length)) {
        errors_fail(ERR_SYNTAX);
    }
    uint16_t variable = expressions_compile_name();
    uint8_t said;
    unsigned dimensions = compile_sizes(&name, list_type, &said);
    if (dimensions == 0) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    emit_integer(said);
    compile_length(0);
    emit_integer(variable);
    emit_integer(preserve);
    emit_action(ACTIONS_REDIM, dimensions + 4);
}

void declare_compile_again(bool preserve) {
    uint8_t list_type = take_type();
    do {
        compile_one_again(list_type, preserve);
    } while (lexer_take(','));
}
