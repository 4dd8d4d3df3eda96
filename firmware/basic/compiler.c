// Source text to code. Context: main loop.
#include "compiler.h"

#include <string.h>

#include "args.h"
#include "blocks.h"
#include "calls.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "labels.h"
#include "lexer.h"
#include "memory.h"
#include "names.h"
#include "source_lines.h"
#include "statements.h"
#include "symbols.h"
#include "vm.h"
#include "words.h"

#define STATEMENT_SIZE 5 // OP_STATEMENT with its operands
#define CODE_PER_CHARACTER 10
#define CODE_AT_LEAST 96
// A line of 255 characters; longer code is "too complex".
#define LINE_CODE_SIZE (SOURCE_LINES_MAX * CODE_PER_CHARACTER)
#define LINE_NUMBER_DIGITS 5

static struct {
    unsigned line; // number of the source line, 0 at the prompt
    uint32_t statement;
    uint32_t last_data; // operand of the last DATA, to be told where the next one is
    uint32_t first_data;
    bool loose;
} compiler;

bool compiler_at_prompt(void) {
    return compiler.line == 0;
}

bool compiler_is_loose(void) {
    return compiler.loose;
}

uint32_t compiler_statement_start(void) {
    return compiler.statement;
}

static void begin_statement(void) {
    compiler.statement = emit_here();
    emit_op(OP_STATEMENT);
    emit_u16(compiler.line);
    emit_u16(0);
}

static void end_statement(uint32_t statement) {
    emit_set_u16(statement + 3, emit_here() - statement);
}

uint32_t compiler_begin_statement(void) {
    begin_statement();
    return compiler.statement;
}

void compiler_end_statement(uint32_t start) {
    end_statement(start);
}

void compiler_new_statement(void) {
    end_statement(compiler.statement);
    begin_statement();
}

// ---- Faults found while compiling ---------------------------------------------------------------

static uint32_t emit_stub(err_t code) {
    uint32_t place = emit_here();
    err_raise(code, "%s", "");
    emit_op(OP_FAIL);
    emit_text(err_message(), strlen(err_message()));
    return place;
}

// ---- DATA ---------------------------------------------------------------------------------------

void compiler_link_data(void) {
    uint32_t here = emit_here() - 1; // OP_DATA
    if (compiler.first_data == 0) {
        compiler.first_data = here;
    } else {
        emit_patch_to(compiler.last_data, here);
    }
    compiler.last_data = emit_here();
    emit_place(0);
}

// ---- Statements ---------------------------------------------------------------------------------

// A statement of this line that fails.
static uint32_t emit_failing(unsigned line, int code) {
    uint32_t start = emit_here();
    emit_op(OP_STATEMENT);
    emit_u16(line);
    emit_u16(0);
    emit_stub((err_t)code);
    end_statement(start);
    return start;
}

void compiler_spoil(uint32_t place, int code) {
    uint32_t size = code_u16(memory.base + place + 3);
    uint32_t over = 0;
    emit_jump(OP_JUMP, &over); // whoever comes along here goes on behind
    uint32_t stub = emit_failing(code_u16(memory.base + place + 1), code);
    emit_jump_to(OP_JUMP, place + size);
    emit_set_jump(place, stub);
    emit_patch(&over);
}

uint32_t compiler_spoil_routine(uint32_t place, int code) {
    unsigned line = code_u16(memory.base + place + 1);
    uint32_t over = 0;
    emit_jump(OP_JUMP, &over);
    uint32_t flow = emit_failing(line, code);
    emit_jump_to(OP_JUMP, place + STATEMENT_SIZE); // where the way around the routine starts
    uint32_t call = emit_failing(line, code);
    uint32_t leave = compiler_begin_statement();
    emit_op(OP_LEAVE);
    end_statement(leave);
    emit_set_jump(place, flow);
    emit_patch(&over);
    return call;
}

static void compile_words(void) {
    const lexer_token_t *token = lexer_now();
    if (lexer_take('?')) {
        statements_print();
        return;
    }
    if (token->kind == LEXER_NAME && token->suffix == 0) {
        int row = words_find(WORDS_STATEMENT, token->text, token->length);
        int command = words_find(WORDS_COMMAND, token->text, token->length);
        if (command != WORDS_NONE && (row == WORDS_NONE || args_fits_command(command))) {
            args_compile_command(command);
            return;
        }
        if (row != WORDS_NONE && !statements_is_value()) {
            lexer_next();
            statements_table[row].compile();
            return;
        }
    }
    if (!statements_compile_other()) {
        errors_fail(ERR_UNKNOWN_COMMAND);
    }
}

void compiler_statement(void) {
    uint32_t outer = compiler.statement;
    expressions_enter(1);
    begin_statement();
    compile_words();
    if (!lexer_at_end()) {
        errors_fail(ERR_SYNTAX);
    }
    end_statement(compiler.statement);
    expressions_leave(1);
    compiler.statement = outer;
}

static void compile_one(void) {
    expressions_start();
    lexer_set_else_ends(false);
    compiler_statement();
}

// Puts the error in the place of a statement that did not compile.
static void emit_failure(uint32_t start) {
    labels_forget(start);
    emit_rollback(start);
    begin_statement();
    emit_op(OP_FAIL);
    emit_text(err_message(), strlen(err_message()));
}

// Blocks and a routine still open end here: at the end of the program, or where the next routine
// starts.
static void close_all(void) {
    if (blocks_abandon() != NULL) {
        statements_abandon_routine();
        blocks_abandon();
    }
    emit_commit();
}

// True if it went well; an error leaves the rest of the line uncompiled.
static bool compile_statement_of_program(void) {
    if (lexer_is_word("SUB") || lexer_is_word("FUNCTION")) {
        close_all();
    }
    uint32_t start = emit_here();
    symbols_t *routine = names_routine();
    blocks_save();
    if (errors_try(compile_one) != ERRORS_NONE) {
        blocks_restore();
        names_restore(routine);
        emit_failure(start);
        end_statement(start);
        return false;
    }
    emit_commit();
    return true;
}

// ---- Lines --------------------------------------------------------------------------------------

// `name:` or a line number opening the line. Returns the text behind.
static const char *compile_label(const char *text, const char *end) {
    lexer_start(text, end);
    const lexer_token_t *token = lexer_now();
    if (token->kind == LEXER_NUMBER && token->value.type == VALUE_INTEGER &&
        token->length <= LINE_NUMBER_DIGITS) {
        labels_define(token->text, token->length);
        return token->behind;
    }
    if (token->kind == LEXER_NAME && token->suffix == 0 && token->behind < end &&
        *token->behind == ':' &&
        words_find(WORDS_STATEMENT, token->text, token->length) == WORDS_NONE) {
        labels_define(token->text, token->length);
        return token->behind + 1;
    }
    return text;
}

static const char *line_start, *line_end; // of the line being compiled
static bool line_too_long;

static void compile_label_of_line(void) {
    if (line_too_long) {
        errors_fail(ERR_LINE_TOO_LONG);
    }
    const char *behind = compile_label(line_start, line_end);
    if (behind != line_start && behind[-1] != ':') { // a line number: a label may follow
        behind = compile_label(behind, line_end);
    }
    line_start = behind;
}

static void compile_line_of_program(void) {
    uint32_t start = emit_here();
    if (errors_try(compile_label_of_line) != ERRORS_NONE) {
        emit_failure(start);
        end_statement(start);
        return;
    }
    lexer_start(line_start, line_end);
    while (lexer_take(':')) {
    }
    while (lexer_now()->kind != LEXER_END) {
        if (!compile_statement_of_program()) {
            return;
        }
        while (lexer_take(':')) {
        }
    }
}

static void each_line(const char *text, size_t length, void (*visit)(void)) {
    source_line_t line;
    source_lines_start(text, length);
    while (source_lines_next(&line)) {
        compiler.line = line.number;
        line_start = line.text;
        line_end = line.end;
        line_too_long = line.too_long;
        visit();
    }
}

// ---- Programs -----------------------------------------------------------------------------------

// SUBs and FUNCTIONs are known before the first line is compiled, so that they can be called
// anywhere.
static void declare_routine(void) {
    lexer_start(line_start, line_end);
    if (lexer_now()->kind == LEXER_NUMBER) {
        lexer_next();
    }
    bool is_function = lexer_take_word("FUNCTION");
    if ((!is_function && !lexer_take_word("SUB")) || lexer_now()->kind != LEXER_NAME) {
        return;
    }
    const lexer_token_t *name = lexer_now();
    if (symbols_find(SYMBOLS_ROUTINE, 0, name->text, lexer_bare_length(name)) != NULL) {
        return; // the second one is an error when its line is compiled
    }
    symbols_routine_t *routine = symbols_memory(sizeof *routine); // first: a name never lacks it
    routine->is_function = is_function;
    routine->type = lexer_suffix_type(name->suffix);
    symbols_t *symbol = symbols_get(SYMBOLS_ROUTINE, 0, name->text, lexer_bare_length(name));
    symbol->routine = routine;
    routine->symbol = memory_handle(symbol);
}

// A line that cannot even be cut into words is reported when it is compiled.
static void declare_routine_of_line(void) {
    errors_try(declare_routine);
}

const uint8_t *compiler_program(const char *text, size_t length) {
    memset(&compiler, 0, sizeof compiler); // .loose as well
    symbols_clear();
    symbols_set_program_mode(true);
    emit_start_program();
    names_start(text);
    lexer_set_escapes(false);
    blocks_start(memory.values);
    names_set_default_type(VALUE_FLOAT);
    uint32_t start = emit_here();
    each_line(text, length, declare_routine_of_line);
    each_line(text, length, compile_line_of_program);
    close_all();
    emit_op(OP_END);
    uint32_t no_line_number = emit_stub(ERR_NO_LINE_NUMBER);
    uint32_t no_label = emit_stub(ERR_NO_LABEL);
    labels_resolve(no_line_number, no_label);
    symbols_set_program_mode(false);
    actions_data_reset(compiler.first_data);
    return memory.base + start;
}

// ---- Lines from the prompt, text that a program makes -------------------------------------------

// Code goes to the scratch. `stack` is where the stack of values is free.
static uint8_t *start_loose(const char *text, size_t length, size_t code_size, value_t *stack) {
    compiler.loose = true;
    uint8_t *code = (uint8_t *)memory_text(code_size);
    emit_start_line(code, code_size);
    blocks_start(stack);
    names_set_default_type(vm.default_type);
    lexer_set_escapes(vm.escapes);
    expressions_start();
    lexer_start(text, text + length);
    return code;
}

static void compile_loose_statements(void) {
    while (lexer_now()->kind != LEXER_END) {
        if (!lexer_take(':')) {
            compile_one();
            emit_commit();
        }
    }
    if (blocks_abandon() != NULL) {
        errors_fail(ERR_NO_END_SUB);
    }
    emit_commit();
}

const uint8_t *compiler_line(const char *text, size_t length) {
    compiler.line = 0;
    names_start_loose(NULL);
    const uint8_t *code = start_loose(text, length, LINE_CODE_SIZE, memory.values);
    const char *behind = lexer_now()->behind;
    if (lexer_now()->kind == LEXER_NUMBER && lexer_now()->value.type == VALUE_INTEGER) {
        lexer_next(); // a line number is no program here: only what follows counts
        bool operator_follows = lexer_is_word("MOD") || lexer_is_word("AND") ||
                                lexer_is_word("OR") || lexer_is_word("XOR");
        if (lexer_now()->kind != LEXER_NAME || operator_follows) {
            behind = text;
        }
        lexer_go(behind);
    }
    compile_loose_statements();
    emit_op(OP_END);
    return code;
}

const uint8_t *compiler_text(const char *text, size_t length, indirect_kind_t end) {
    compiler.line = vm_line();
    names_start_loose(calls_routine());
    const uint8_t *code =
        start_loose(text, length, length * CODE_PER_CHARACTER + CODE_AT_LEAST, vm.sp);
    if (end == INDIRECT_EVAL_END) {
        expressions_compile();
        if (lexer_now()->kind != LEXER_END) {
            errors_fail(ERR_SYNTAX);
        }
        emit_commit();
    } else {
        compile_loose_statements();
    }
    emit_indirect(end, 0);
    return code;
}
