// SORT and MATH. Context: main loop, while compiling.
#include "base/base.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"

static void compile_array(void) {
    if (lexer_now()->kind != LEXER_NAME) {
        errors_fail(ERR_SYNTAX);
    }
    expressions_compile_variable(false, true);
}

// SORT array() [, index()] [, flags] [, start] [, count], each of which may be left blank.
void statements_sort(void) {
    static const char kinds[] = "annn";
    compile_array();
    for (const char *kind = kinds; *kind != '\0'; kind++) {
        bool more = lexer_take(',');
        if (!more || lexer_is(',') || lexer_at_end()) {
            emit_op(OP_BLANK);
        } else if (*kind == 'a') {
            compile_array();
        } else {
            expressions_compile();
        }
    }
    emit_action(ACTIONS_SORT, 1 + sizeof kinds - 1);
}

void statements_math(void) {
    static const struct {
        const char *word;
        const char *kinds; // a an array, n a number
        actions_t action;
    } rows[] = {
        {"SET", "na", ACTIONS_MATH_SET},
        {"SCALE", "ana", ACTIONS_MATH_SCALE},
        {"ADD", "ana", ACTIONS_MATH_ADD},
        {"INTERPOLATE", "aana", ACTIONS_MATH_INTERPOLATE},
    };
    for (size_t i = 0; i < COUNT_OF_ARRAY(rows); i++) {
        if (!lexer_take_word(rows[i].word)) {
            continue;
        }
        unsigned count = 0;
        for (const char *kind = rows[i].kinds; *kind != '\0'; kind++) {
            if (count++ > 0) {
                lexer_expect(',');
            }
            if (*kind == 'a') {
                compile_array();
            } else {
                expressions_compile();
            }
        }
        emit_action(rows[i].action, count);
        return;
    }
    errors_fail_with(ERR_UNKNOWN_SUBCOMMAND, "MATH");
}
