// VAR SAVE, VAR RESTORE and VAR CLEAR. Context: main loop, while compiling.
#include "actions.h"
#include "code.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "memory.h"
#include "statements.h"
#include "symbols.h"

#define VARIABLES_MAX 32u

// A variable of the program by its handle: a local or a STATIC has no name that could be found
// again.
static void compile_variable(void) {
    if (lexer_now()->kind != LEXER_NAME) {
        errors_fail(ERR_SYNTAX);
    }
    uint16_t variable = expressions_compile_name();
    const symbols_t *symbol = variable & CODE_LOCAL_FLAG ? NULL : memory_place(variable);
    if (symbol == NULL || symbol->scope != 0) {
        errors_fail(ERR_INVALID_HERE);
    }
    if (lexer_take('(')) {
        lexer_expect(')');
    }
    emit_integer(variable);
}

static void compile_save(void) {
    unsigned count = 0;
    do {
        if (++count > VARIABLES_MAX) {
            errors_fail(ERR_TOO_COMPLEX);
        }
        compile_variable();
    } while (lexer_take(','));
    emit_action(ACTIONS_VAR_SAVE, count);
}

void statements_var(void) {
    if (lexer_take_word("SAVE")) {
        compile_save();
    } else if (lexer_take_word("RESTORE")) {
        emit_action(ACTIONS_VAR_RESTORE, 0);
    } else if (lexer_take_word("CLEAR")) {
        emit_action(ACTIONS_VAR_CLEAR, 0);
    } else {
        errors_fail(ERR_SYNTAX);
    }
}
