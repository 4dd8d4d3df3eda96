// Commands about files, and XMODEM. Context: main loop, while compiling.
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"

static void compile_path(actions_t action) {
    expressions_compile();
    emit_action(action, 1);
}

void statements_mkdir(void) {
    compile_path(ACTIONS_MKDIR);
}

void statements_rmdir(void) {
    compile_path(ACTIONS_RMDIR);
}

void statements_chdir(void) {
    compile_path(ACTIONS_CHDIR);
}

// FILES [pattern$]
void statements_files(void) {
    bool given = !lexer_at_end();
    if (given) {
        expressions_compile();
    }
    emit_action(ACTIONS_FILES, given);
}

// KILL name$ [, ALL]
void statements_kill(void) {
    expressions_compile();
    bool all = lexer_take(',');
    if (all) {
        lexer_expect_word("ALL");
    }
    emit_integer(all);
    emit_action(ACTIONS_KILL, 2);
}

// name$ word name$
static void compile_two_paths(const char *word, actions_t action) {
    expressions_compile();
    lexer_expect_word(word);
    expressions_compile();
    emit_action(action, 2);
}

void statements_rename(void) {
    compile_two_paths("AS", ACTIONS_RENAME);
}

void statements_copy(void) {
    compile_two_paths("TO", ACTIONS_COPY);
}

// XMODEM SEND|RECEIVE [name$]; without a name it is the program.
void statements_xmodem(void) {
    bool receive = lexer_take_word("RECEIVE") || lexer_take_word("R");
    if (!receive && !lexer_take_word("S")) {
        lexer_expect_word("SEND");
    }
    bool named = !lexer_at_end();
    if (named) {
        expressions_compile();
    } else if (receive && !compiler_at_prompt()) {
        errors_fail(ERR_NOT_IN_PROGRAM); // it would saw off the branch it sits on
    }
    emit_action(receive ? ACTIONS_XMODEM_RECEIVE : ACTIONS_XMODEM_SEND, named);
}
