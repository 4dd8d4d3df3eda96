// SUB, FUNCTION, LOCAL, STATIC, CALL and EXECUTE. Context: main loop, while compiling.
#include "blocks.h"
#include "compiler.h"
#include "declare.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "lexer.h"
#include "names.h"
#include "statements.h"
#include "symbols.h"
#include "words.h"

// `a`, `b%`, `c$`, `d AS INTEGER`, `e()`; with BYVAL or BYREF before
static void compile_parameter(symbols_routine_t *routine) {
    bool by_value = lexer_take_word("BYVAL");
    if (!by_value) {
        lexer_take_word("BYREF"); // as it is anyway
    }
    lexer_token_t name = *lexer_now();
    if (name.kind != LEXER_NAME || words_is_reserved(name.text, name.length)) {
        errors_fail(ERR_SYNTAX);
    }
    if (routine->parameters == SYMBOLS_PARAMETERS_MAX) {
        errors_fail(ERR_ARGUMENT_LIST);
    }
    lexer_next();
    bool is_array = lexer_take('(');
    if (is_array) {
        lexer_expect(')');
    }
    if (is_array && by_value) {
        errors_fail(ERR_SYNTAX);
    }
    uint8_t type = lexer_suffix_type(name.suffix);
    if (lexer_take_word("AS")) {
        type = declare_type_at_hand();
    }
    if (type == VALUE_NONE) {
        type = names_default_type();
    }
    if (type == VALUE_NONE) {
        errors_fail(ERR_NO_TYPE);
    }
    names_local(&name, type);
    routine->parameter_types[routine->parameters++] =
        (uint8_t)(type | (is_array   ? SYMBOLS_ARRAY_FLAG
                          : by_value ? SYMBOLS_VALUE_FLAG
                                     : 0));
}

static void compile_parameters(symbols_routine_t *routine) {
    bool parentheses = lexer_take('(');
    routine->parameters = 0;
    bool none = parentheses ? lexer_is(')') : lexer_at_end();
    while (!none) {
        compile_parameter(routine);
        none = !lexer_take(',');
    }
    if (parentheses) {
        lexer_expect(')');
    }
}

static uint8_t function_type(const lexer_token_t *name) {
    uint8_t type = lexer_suffix_type(name->suffix);
    return type != VALUE_NONE                   ? type
           : names_default_type() != VALUE_NONE ? names_default_type()
                                                : VALUE_FLOAT;
}

// FUNCTION's AS stands behind the parameters, but its name is a local from the start.
static void compile_type_of_function(symbols_t *symbol) {
    if (lexer_take_word("AS")) {
        symbol->routine->type = declare_type_at_hand();
        names_set_result_type(symbol->routine->type);
    }
}

static void compile_routine(bool is_function) {
    lexer_token_t name = *lexer_now();
    if (compiler_is_loose() || name.kind != LEXER_NAME) {
        errors_fail(compiler_is_loose() ? ERR_INVALID_HERE : ERR_SYNTAX);
    }
    symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, name.text, lexer_bare_length(&name));
    if (symbol == NULL) { // not at the start of a line, where it would have been declared
        errors_fail(ERR_INVALID_HERE);
    }
    if (symbol->routine->code != 0) {
        errors_fail_with(ERR_SUB_TWICE, "%s", symbol->name);
    }
    symbol->routine->type = is_function ? function_type(&name) : VALUE_INTEGER;
    names_begin_routine(symbol);
    lexer_next();
    compile_parameters(symbol->routine);
    if (is_function) {
        compile_type_of_function(symbol);
    }
    if (!lexer_at_end()) {
        errors_fail(ERR_SYNTAX);
    }
    blocks_t *block = blocks_open(BLOCKS_ROUTINE);
    emit_jump(OP_JUMP, &block->exits); // the program's own flow goes around it
    symbol->routine->code = emit_here();
}

void statements_sub(void) {
    compile_routine(false);
}

void statements_function(void) {
    compile_routine(true);
}

static void close_routine(blocks_t *block) {
    emit_op(OP_LEAVE);
    emit_patch(&block->exits);
    names_end_routine();
    blocks_close();
}

void statements_end_routine(void) {
    bool function = lexer_is_word("FUNCTION");
    lexer_next();
    const symbols_t *routine = names_routine();
    if (routine == NULL || routine->routine->is_function != function || !lexer_at_end()) {
        errors_fail(routine == NULL ? ERR_NO_RETURN : ERR_SYNTAX);
    }
    close_routine(blocks_abandon());
}

void statements_abandon_routine(void) {
    blocks_t *block = blocks_top(BLOCKS_ROUTINE);
    symbols_routine_t *routine = names_routine()->routine;
    uint32_t opening = block->opening;
    uint32_t leave = compiler_begin_statement(); // or ON ERROR would come back to it for ever
    close_routine(block);
    compiler_end_statement(leave);
    routine->code = compiler_spoil_routine(opening, ERR_NO_END_SUB);
}

void statements_call(void) {
    expressions_compile();
    unsigned count = lexer_take(',') ? expressions_compile_arguments(0) : 0;
    emit_indirect(INDIRECT_SUB, count);
}

void statements_execute(void) {
    expressions_compile();
    emit_indirect(INDIRECT_EXECUTE, 1);
}

void statements_local(void) {
    if (names_routine() == NULL) {
        errors_fail(ERR_INVALID_HERE);
    }
    declare_compile(DECLARE_LOCAL);
}

void statements_static(void) {
    if (names_routine() == NULL) {
        errors_fail(ERR_INVALID_HERE);
    }
    declare_compile(DECLARE_STATIC);
}
