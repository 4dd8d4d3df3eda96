// The statement OPTION for what outlives power-off. Context: main loop, while compiling.
#include "actions.h"
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "function_keys.h"
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

// F1 to F12; 0 if it is none of them.
static unsigned take_function_key(void) {
    static const char *const names[FUNCTION_KEYS_COUNT] = {
        "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12",
    };
    for (unsigned i = 0; i < FUNCTION_KEYS_COUNT; i++) {
        if (lexer_take_word(names[i])) {
            return i + 1;
        }
    }
    return 0;
}

bool statements_option_kept(void) {
    unsigned key = take_function_key();
    if (key != 0) {
        emit_integer(key);
        expressions_compile();
        emit_action(ACTIONS_OPTION_KEY, 2);
        return true;
    }
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
