// Assignments: to variables, and to what looks like a function. Context: main loop, while
// compiling.
#include "actions.h"
#include "args.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"
#include "words.h"

// `name(arguments) = value`: r a variable to write to, n an expression, N one that may be left out.
static const struct {
    const char *name;
    const char *kinds; // empty: without parentheses
    actions_t action;  // gets the arguments and the value
} targets[] = {
    {"BIT", "rn", ACTIONS_SET_BIT},  {"BYTE", "rn", ACTIONS_SET_BYTE},
    {"DATE$", "", ACTIONS_SET_DATE}, {"MID$", "rnN", ACTIONS_SET_MID},
    {"TIME$", "", ACTIONS_SET_TIME},
};

static unsigned compile_arguments(const char *kinds) {
    unsigned count = 0;
    lexer_expect('(');
    for (; *kinds != '\0' && !(*kinds == 'N' && lexer_is(')')); kinds++) {
        if (count++ > 0) {
            lexer_expect(',');
        }
        if (*kinds == 'r') {
            expressions_compile_reference();
        } else {
            expressions_compile();
        }
    }
    lexer_expect(')');
    return count;
}

static bool compile_to_function(void) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(targets); i++) {
        if (lexer_take_word(targets[i].name)) {
            unsigned count = *targets[i].kinds != '\0' ? compile_arguments(targets[i].kinds) : 0;
            lexer_expect('=');
            expressions_compile();
            emit_action(targets[i].action, count + 1);
            return true;
        }
    }
    int row = words_find(WORDS_ASSIGNMENT, lexer_now()->text, lexer_now()->length);
    if (row != WORDS_NONE) {
        args_compile_assignment(row);
        return true;
    }
    return false;
}

static void compile_to_variable(void) {
    const lexer_token_t *name = lexer_now();
    if (words_is_reserved(name->text, name->length) ||
        words_find(WORDS_FUNCTION, name->text, name->length) != WORDS_NONE) {
        errors_fail(ERR_SYNTAX);
    }
    uint16_t variable = expressions_compile_name();
    if (lexer_is('(')) {
        unsigned count = expressions_compile_subscripts();
        lexer_expect('=');
        expressions_compile();
        emit_element(OP_STORE_ELEMENT, variable, count);
    } else {
        lexer_expect('=');
        expressions_compile();
        emit_variable(OP_STORE, variable);
    }
}

void statements_let(void) {
    if (lexer_now()->kind != LEXER_NAME) {
        errors_fail(ERR_SYNTAX);
    }
    if (!compile_to_function()) {
        compile_to_variable();
    }
}
