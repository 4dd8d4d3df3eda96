// OPEN, CLOSE, SEEK, FLUSH, and what PRINT, INPUT and LINE INPUT do with a channel. Context: main
// loop, while compiling.
#include "basic/basic_device.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "statements.h"

// [#]n
static void compile_number(void) {
    lexer_take('#');
    expressions_compile();
}

static basic_device_mode_t compile_mode(void) {
    static const struct {
        const char *word;
        basic_device_mode_t mode;
    } modes[] = {
        {"INPUT", BASIC_DEVICE_INPUT},
        {"OUTPUT", BASIC_DEVICE_OUTPUT},
        {"APPEND", BASIC_DEVICE_APPEND},
        {"RANDOM", BASIC_DEVICE_RANDOM},
    };
    for (size_t i = 0; i < COUNT_OF_ARRAY(modes); i++) {
        if (lexer_take_word(modes[i].word)) {
            return modes[i].mode;
        }
    }
    errors_fail(ERR_SYNTAX);
}

// OPEN name$ [FOR mode] AS [#]n
void statements_open(void) {
    expressions_compile();
    emit_integer(lexer_take_word("FOR") ? compile_mode() : BASIC_DEVICE_UNSAID);
    lexer_expect_word("AS");
    compile_number();
    emit_action(ACTIONS_OPEN, 3);
}

// CLOSE [[#]n [, ...]]
void statements_close(void) {
    if (lexer_at_end()) {
        emit_action(ACTIONS_CLOSE, 0);
        return;
    }
    do {
        compile_number();
        emit_action(ACTIONS_CLOSE, 1);
    } while (lexer_take(','));
}

// SEEK [#]n, position
void statements_seek(void) {
    compile_number();
    lexer_expect(',');
    expressions_compile();
    emit_action(ACTIONS_SEEK, 2);
}

void statements_flush(void) {
    compile_number();
    emit_action(ACTIONS_FLUSH, 1);
}

// One value, or a blank and the column for TAB(); returns how many places of the stack it takes.
static unsigned compile_print_item(void) {
    if (!lexer_take_word("TAB")) {
        expressions_compile();
        return 1;
    }
    emit_op(OP_BLANK);
    if (expressions_compile_subscripts() != 1) {
        errors_fail(ERR_ARGUMENT_COUNT);
    }
    return 2;
}

// PRINT #n [, value [;|, ...]]: all values are computed before the first is written, so that an
// error leaves no half of a line behind.
void statements_print_channel(void) {
    expressions_compile();
    unsigned count = 1;
    bool line_open = false;
    if (!lexer_at_end() && !lexer_take(',')) {
        lexer_expect(';');
    }
    while (!lexer_at_end()) {
        line_open = lexer_take(';');
        if (line_open) {
            continue;
        }
        line_open = lexer_take(',');
        if (line_open) {
            emit_string("\t", 1);
            count++;
        } else {
            count += compile_print_item();
        }
    }
    if (!line_open) {
        emit_string("\r\n", 2);
        count++;
    }
    emit_action(ACTIONS_PRINT_CHANNEL, count);
}

// INPUT #n, names: the line; the names follow as without a channel.
void statements_input_channel(void) {
    expressions_compile();
    lexer_expect(',');
    emit_action(ACTIONS_INPUT_CHANNEL, 1);
}

void statements_line_input_channel(void) {
    expressions_compile();
    lexer_expect(',');
    expressions_compile_reference();
    emit_action(ACTIONS_LINE_INPUT_CHANNEL, 2);
}
