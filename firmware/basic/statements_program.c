// Statements about the program as a whole: RUN, NEW, LOAD, SAVE. Context: main loop, while
// compiling.
#include "actions.h"
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"

// Deleting or replacing the program while it runs would saw off the branch it sits on.
static void at_prompt_only(void) {
    if (!compiler_at_prompt()) {
        errors_fail(ERR_NOT_IN_PROGRAM);
    }
}

// RUN [file$] [, argument$]; an empty name is the program at hand.
void statements_run(void) {
    unsigned count = 0;
    if (!lexer_at_end()) {
        if (lexer_is(',')) {
            emit_string("", 0);
        } else {
            expressions_compile();
        }
        count = 1;
        if (lexer_take(',')) {
            expressions_compile();
            count = 2;
        }
    }
    emit_action(ACTIONS_RUN, count);
}

void statements_new(void) {
    at_prompt_only();
    emit_action(ACTIONS_NEW, 0);
}

void statements_load(void) {
    at_prompt_only();
    expressions_compile();
    bool runs = false;
    if (lexer_take(',')) {
        runs = lexer_take_word("R");
        if (!runs) {
            errors_fail(ERR_SYNTAX);
        }
    }
    emit_integer(runs);
    emit_action(ACTIONS_LOAD, 2);
}

void statements_save(void) {
    expressions_compile();
    emit_action(ACTIONS_SAVE, 1);
}
