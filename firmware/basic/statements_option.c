// The statement OPTION for what outlives power-off. Context: main loop, while compiling.
#include "actions.h"
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "options.h"
#include "statements.h"

static const struct {
    const char *word;
    options_t option;
    bool is_switch; // ON or OFF; else a number
} kept[] = {
    {"AUTORUN", OPTIONS_AUTORUN, true},   {"BREAK", OPTIONS_BREAK, false},
    {"COLOURCODE", OPTIONS_COLOUR, true}, {"COLORCODE", OPTIONS_COLOUR, true},
    {"TAB", OPTIONS_TAB, false},
};

static void compile_switch(void) {
    bool on = lexer_take_word("ON");
    if (!on && !lexer_take_word("OFF")) {
        errors_fail(ERR_SYNTAX);
    }
    emit_integer(on);
}

static void compile_display(void) {
    expressions_compile();
    bool columns = lexer_take(',');
    if (columns) {
        expressions_compile();
    }
    emit_action(ACTIONS_OPTION_DISPLAY, 1 + columns);
}

bool statements_option_kept(void) {
    if (lexer_take_word("LIST")) {
        emit_action(ACTIONS_OPTION_LIST, 0);
        return true;
    }
    if (lexer_take_word("RESET")) {
        emit_action(ACTIONS_OPTION_RESET, 0);
        return true;
    }
    if (lexer_take_word("FORMAT")) {
        if (!compiler_at_prompt()) {
            errors_fail(ERR_NOT_IN_PROGRAM);
        }
        expressions_compile();
        emit_action(ACTIONS_OPTION_FORMAT, 1);
        return true;
    }
    if (lexer_take_word("DISPLAY")) {
        compile_display();
        return true;
    }
    for (size_t i = 0; i < COUNT_OF_ARRAY(kept); i++) {
        if (lexer_take_word(kept[i].word)) {
            emit_integer(kept[i].option);
            if (kept[i].is_switch) {
                compile_switch();
            } else {
                expressions_compile();
            }
            emit_action(ACTIONS_OPTION_KEEP, 2);
            return true;
        }
    }
    return false;
}
