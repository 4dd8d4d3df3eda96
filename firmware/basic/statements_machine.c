// CPU, UPDATE FIRMWARE, WATCHDOG and TRACE. Context: main loop, while compiling.
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"
#include "trace.h"

static void expect_word(const char *word) {
    if (!lexer_take_word(word)) {
        errors_fail(ERR_SYNTAX);
    }
}

// CPU RESTART [BOOTSEL]
void statements_cpu(void) {
    expect_word("RESTART");
    emit_integer(lexer_take_word("BOOTSEL"));
    emit_action(ACTIONS_RESTART, 1);
}

void statements_update(void) {
    expect_word("FIRMWARE");
    emit_integer(1);
    emit_action(ACTIONS_RESTART, 1);
}

// WATCHDOG milliseconds|OFF
void statements_watchdog(void) {
    if (lexer_take_word("OFF")) {
        emit_integer(0);
    } else {
        expressions_compile();
    }
    emit_action(ACTIONS_WATCHDOG, 1);
}

// TRACE ON|OFF / TRACE LIST [n]
void statements_trace(void) {
    if (lexer_take_word("LIST")) {
        if (lexer_at_end()) {
            emit_integer(TRACE_LINES);
        } else {
            expressions_compile();
        }
        emit_action(ACTIONS_TRACE_LIST, 1);
        return;
    }
    bool on = lexer_take_word("ON");
    if (!on) {
        expect_word("OFF");
    }
    emit_integer(on);
    emit_action(ACTIONS_TRACE, 1);
}
