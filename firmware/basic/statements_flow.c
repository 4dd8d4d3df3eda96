// IF, FOR, DO, SELECT CASE, GOTO and their kin. Blocks are matched while compiling, so at run time
// they are nothing but jumps. Context: main loop, while compiling.
#include "blocks.h"
#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "expressions.h"
#include "labels.h"
#include "lexer.h"
#include "names.h"
#include "statements.h"
#include "words.h"

// ---- IF -----------------------------------------------------------------------------------------

// What THEN or ELSE leads to in a single-line IF: a line number, or one statement.
static void compile_branch(void) {
    if (lexer_now()->kind == LEXER_NUMBER) {
        labels_jump(OP_JUMP);
    } else {
        compiler_statement();
    }
}

static void compile_single_line(uint32_t *otherwise) {
    bool outer = lexer_set_else_ends(true);
    compile_branch();
    while (lexer_take(':')) {
        if (!lexer_at_end()) {
            compile_branch();
        }
    }
    lexer_set_else_ends(outer);
    if (lexer_take_word("ELSE")) {
        uint32_t done = 0;
        emit_jump(OP_JUMP, &done);
        emit_patch(otherwise);
        compile_branch();
        emit_patch(&done);
    } else {
        emit_patch(otherwise);
    }
}

void statements_if(void) {
    uint32_t otherwise = 0;
    expressions_compile();
    emit_jump(OP_JUMP_FALSE, &otherwise);
    if (lexer_is_word("GOTO")) {
        compile_single_line(&otherwise);
    } else {
        lexer_expect_word("THEN");
        if (lexer_now()->kind == LEXER_END) {
            blocks_open(BLOCKS_IF)->next_case = otherwise;
            return;
        }
        compile_single_line(&otherwise);
    }
}

static blocks_t *open_if(const char *word) {
    blocks_t *block = blocks_top(BLOCKS_IF);
    if (block == NULL) {
        errors_fail_with(ERR_NO_IF, "%s", word);
    }
    return block;
}

void statements_elseif(void) {
    blocks_t *block = open_if("ELSEIF");
    if (block->seen_else) {
        errors_fail_with(ERR_NO_IF, "ELSEIF");
    }
    emit_jump(OP_JUMP, &block->exits);
    emit_patch(&block->next_case);
    compiler_new_statement();
    expressions_compile();
    lexer_expect_word("THEN");
    emit_jump(OP_JUMP_FALSE, &block->next_case);
}

void statements_else(void) {
    if (lexer_take_word("IF")) {
        statements_elseif();
        return;
    }
    blocks_t *block = open_if("ELSE");
    if (block->seen_else) {
        errors_fail_with(ERR_NO_IF, "ELSE");
    }
    block->seen_else = true;
    emit_jump(OP_JUMP, &block->exits);
    emit_patch(&block->next_case);
}

void statements_endif(void) {
    blocks_t *block = open_if("ENDIF");
    emit_patch(&block->exits);
    emit_patch(&block->next_case);
    blocks_close();
}

// ---- FOR ----------------------------------------------------------------------------------------

void statements_for(void) {
    if (lexer_now()->kind != LEXER_NAME ||
        words_is_reserved(lexer_now()->text, lexer_now()->length)) {
        errors_fail(ERR_SYNTAX);
    }
    uint16_t variable = expressions_compile_name();
    lexer_expect('=');
    expressions_compile();
    emit_variable(OP_STORE, variable);
    lexer_expect_word("TO");
    expressions_compile();
    if (lexer_take_word("STEP")) {
        expressions_compile();
    } else {
        emit_integer(1);
    }
    blocks_t *block = blocks_open(BLOCKS_FOR);
    block->variable = variable;
    block->hidden = names_hidden(2);
    emit_variable(OP_FOR, variable);
    emit_u16(block->hidden);
    emit_wait(&block->exits);
    block->body = emit_here();
}

static void close_for(void) {
    blocks_t *block = blocks_top(BLOCKS_FOR);
    if (block == NULL) {
        errors_fail(ERR_NO_FOR);
    }
    if (lexer_now()->kind == LEXER_NAME && !lexer_at_end()) {
        uint8_t check_type;
        if (names_variable(lexer_now(), &check_type) != block->variable) {
            errors_fail(ERR_NO_FOR);
        }
        lexer_next();
    }
    emit_patch(&block->next_case); // CONTINUE FOR
    emit_variable(OP_NEXT, block->variable);
    emit_u16(block->hidden);
    emit_place(block->body);
    emit_patch(&block->exits);
    blocks_close();
}

void statements_next(void) {
    close_for();
    while (lexer_take(',')) {
        close_for();
    }
}

// ---- DO -----------------------------------------------------------------------------------------

// [WHILE|UNTIL condition]: jumps to `chain` when the loop is over. False if there is no condition.
static bool compile_condition(uint32_t *chain) {
    bool until = lexer_is_word("UNTIL");
    if (!until && !lexer_is_word("WHILE")) {
        return false;
    }
    lexer_next();
    expressions_compile();
    emit_jump(until ? OP_JUMP_TRUE : OP_JUMP_FALSE, chain);
    return true;
}

void statements_do(void) {
    blocks_t *block = blocks_open(BLOCKS_DO);
    block->body = compiler_statement_start();
    if (!compile_condition(&block->exits)) {
        block->body = emit_here();
    }
}

void statements_while(void) {
    blocks_t *block = blocks_open(BLOCKS_DO);
    block->body = compiler_statement_start();
    expressions_compile();
    emit_jump(OP_JUMP_FALSE, &block->exits);
}

void statements_loop(void) {
    blocks_t *block = blocks_top(BLOCKS_DO);
    if (block == NULL) {
        errors_fail(ERR_NO_DO);
    }
    emit_patch(&block->next_case); // CONTINUE DO
    compile_condition(&block->exits);
    emit_jump_to(OP_JUMP, block->body);
    emit_patch(&block->exits);
    blocks_close();
}

void statements_wend(void) {
    statements_loop();
}

// ---- EXIT, CONTINUE -----------------------------------------------------------------------------

static blocks_t *loop_at_hand(void) {
    if (lexer_take_word("FOR")) {
        blocks_t *block = blocks_find(BLOCKS_FOR);
        if (block == NULL) {
            errors_fail(ERR_NO_FOR_LOOP);
        }
        return block;
    }
    lexer_take_word("DO");
    blocks_t *block = blocks_find(BLOCKS_DO);
    if (block == NULL) {
        errors_fail(ERR_NO_DO_LOOP);
    }
    return block;
}

void statements_exit(void) {
    if (lexer_is_word("SUB") || lexer_is_word("FUNCTION")) {
        bool function = lexer_is_word("FUNCTION");
        const symbols_t *routine = names_routine();
        if (routine == NULL || routine->routine->is_function != function) {
            errors_fail(ERR_NO_RETURN);
        }
        lexer_next();
        emit_op(OP_LEAVE);
        return;
    }
    emit_jump(OP_JUMP, &loop_at_hand()->exits);
}

void statements_continue(void) {
    emit_jump(OP_JUMP, &loop_at_hand()->next_case);
}

// ---- SELECT CASE --------------------------------------------------------------------------------

void statements_select(void) {
    lexer_expect_word("CASE");
    expressions_compile();
    blocks_t *block = blocks_open(BLOCKS_SELECT);
    block->hidden = names_hidden(2);
    emit_variable(OP_KEEP, block->hidden);
    emit_jump(OP_JUMP, &block->next_case);
}

static code_op_t comparison_at_hand(void) {
    static const struct {
        int symbol;
        code_op_t op;
    } comparisons[] = {
        {'=', OP_EQUAL},
        {'<', OP_LESS},
        {'>', OP_GREATER},
        {LEXER_PAIR('<', '>'), OP_NOT_EQUAL},
        {LEXER_PAIR('<', '='), OP_LESS_EQUAL},
        {LEXER_PAIR('=', '<'), OP_LESS_EQUAL},
        {LEXER_PAIR('>', '='), OP_GREATER_EQUAL},
        {LEXER_PAIR('=', '>'), OP_GREATER_EQUAL},
    };
    for (size_t i = 0; i < sizeof comparisons / sizeof comparisons[0]; i++) {
        if (lexer_take(comparisons[i].symbol)) {
            return comparisons[i].op;
        }
    }
    errors_fail(ERR_SYNTAX);
}

// One item of CASE: a value, `a TO b` or `IS < a`. Jumps to `body` if it fits.
static void compile_case(uint16_t hidden, uint32_t *body) {
    emit_variable(OP_LOAD, hidden);
    if (lexer_take_word("IS")) {
        code_op_t op = comparison_at_hand();
        expressions_compile();
        emit_op(op);
        emit_jump(OP_JUMP_TRUE, body);
        return;
    }
    expressions_compile();
    if (!lexer_take_word("TO")) {
        emit_op(OP_EQUAL);
        emit_jump(OP_JUMP_TRUE, body);
        return;
    }
    uint32_t below = 0;
    emit_op(OP_GREATER_EQUAL);
    emit_jump(OP_JUMP_FALSE, &below);
    emit_variable(OP_LOAD, hidden);
    expressions_compile();
    emit_op(OP_LESS_EQUAL);
    emit_jump(OP_JUMP_TRUE, body);
    emit_patch(&below);
}

void statements_case(void) {
    blocks_t *block = blocks_top(BLOCKS_SELECT);
    if (block == NULL || block->seen_else) {
        errors_fail_with(ERR_NO_SELECT, "CASE");
    }
    emit_jump(OP_JUMP, &block->exits); // from the body of the case above
    emit_patch(&block->next_case);
    compiler_new_statement();
    if (lexer_take_word("ELSE")) {
        block->seen_else = true;
        return;
    }
    uint32_t body = 0;
    do {
        compile_case(block->hidden, &body);
    } while (lexer_take(','));
    emit_jump(OP_JUMP, &block->next_case);
    emit_patch(&body);
}

static void compile_end_select(void) {
    blocks_t *block = blocks_top(BLOCKS_SELECT);
    if (block == NULL) {
        errors_fail_with(ERR_NO_SELECT, "END SELECT");
    }
    emit_patch(&block->next_case);
    emit_patch(&block->exits);
    blocks_close();
}

// ---- Jumps --------------------------------------------------------------------------------------

void statements_goto(void) {
    labels_jump(OP_JUMP);
}

void statements_gosub(void) {
    labels_jump(OP_GOSUB);
}

void statements_return(void) {
    emit_op(OP_RETURN);
}

// ON n GOTO|GOSUB label, label ...: n is kept and compared with 1, 2, 3 in turn.
void statements_on(void) {
    if (lexer_take_word("ERROR")) {
        statements_on_error();
        return;
    }
    if (lexer_take_word("KEY")) {
        statements_on_key();
        return;
    }
    uint16_t hidden = names_hidden(1);
    expressions_compile();
    emit_op(OP_FUNCTION);
    emit_byte((unsigned)words_find(WORDS_FUNCTION, "CINT", 4));
    emit_byte(1);
    emit_variable(OP_KEEP, hidden);
    bool gosub = lexer_is_word("GOSUB");
    if (!gosub && !lexer_is_word("GOTO")) {
        errors_fail(ERR_SYNTAX);
    }
    lexer_next();
    uint32_t done = 0;
    unsigned number = 0;
    do {
        uint32_t next = 0;
        emit_variable(OP_LOAD, hidden);
        emit_integer(++number);
        emit_op(OP_EQUAL);
        emit_jump(OP_JUMP_FALSE, &next);
        labels_jump(gosub ? OP_GOSUB : OP_JUMP);
        emit_jump(OP_JUMP, &done);
        emit_patch(&next);
    } while (lexer_take(','));
    emit_patch(&done);
}

// ---- END ----------------------------------------------------------------------------------------

void statements_end(void) {
    if (lexer_take_word("IF")) {
        statements_endif();
    } else if (lexer_take_word("SELECT")) {
        compile_end_select();
    } else if (lexer_is_word("SUB") || lexer_is_word("FUNCTION")) {
        statements_end_routine();
    } else {
        emit_integer(lexer_take_word("NOEND"));
        emit_action(ACTIONS_END, 1);
    }
}
