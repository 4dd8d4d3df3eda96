// SETTICK and ON KEY. Context: main loop, while compiling.
#include "args.h"
#include "emit.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"

// The clock's number, behind a comma if it is given.
static void compile_number(void) {
    if (lexer_take(',')) {
        expressions_compile();
    } else {
        emit_integer(1);
    }
}

// SETTICK PAUSE|RESUME [, sub] [, number]; the SUB says nothing that the number does not.
static void compile_hold(bool hold) {
    emit_integer(hold);
    if (lexer_take(',') && !lexer_is(',')) {
        args_compile_routine();
    } else {
        emit_integer(0);
    }
    compile_number();
    emit_action(ACTIONS_SETTICK_HOLD, 3);
}

void statements_settick(void) {
    bool hold = lexer_take_word("PAUSE");
    if (hold || lexer_take_word("RESUME")) {
        compile_hold(hold);
        return;
    }
    expressions_compile();
    lexer_expect(',');
    args_compile_routine();
    compile_number();
    emit_action(ACTIONS_SETTICK, 3);
}

// True if there is a second argument.
static bool has_comma(void) {
    const char *start = lexer_now()->text;
    int depth = 0;
    bool found = false;
    while (!lexer_at_end() && !found) {
        depth += lexer_is('(') - lexer_is(')');
        found = depth == 0 && lexer_is(',');
        lexer_next();
    }
    lexer_go(start);
    return found;
}

// ON KEY sub / ON KEY code, sub
void statements_on_key(void) {
    if (!has_comma()) {
        args_compile_routine();
        emit_action(ACTIONS_ON_KEY, 1);
        return;
    }
    expressions_compile();
    lexer_expect(',');
    args_compile_routine();
    emit_action(ACTIONS_ON_KEY_CODE, 2);
}
