// Expressions. Operators are rows of a table: to add one, add a row. Context: main loop, while
// compiling.
#include "expressions.h"

#include <string.h>

#include "args.h"
#include "emit.h"
#include "errors.h"
#include "function_calls.h"
#include "lexer.h"
#include "memory.h"
#include "names.h"
#include "symbols.h"
#include "words.h"

// The C stack bounds what may stand inside each other: an operator that binds more tightly than the
// one before costs some 60 bytes of it, and counts one; parentheses, arguments and subscripts count
// four.
#define NESTING_MAX 132

typedef struct {
    int symbol;
    const char *word; // instead of a symbol
    uint8_t precedence;
    uint8_t op;
} operator_t;

// MMBasic's order, tightest first; operators of one row of the manual go left to right.
static const operator_t operators[] = {
    {'^', NULL, 7, OP_POWER},
    {'*', NULL, 6, OP_MULTIPLY},
    {'/', NULL, 6, OP_DIVIDE},
    {'\\', NULL, 6, OP_INT_DIVIDE},
    {0, "MOD", 6, OP_MOD},
    {'+', NULL, 5, OP_ADD},
    {'-', NULL, 5, OP_SUBTRACT},
    {LEXER_PAIR('<', '<'), NULL, 4, OP_SHIFT_LEFT},
    {LEXER_PAIR('>', '>'), NULL, 4, OP_SHIFT_RIGHT},
    {LEXER_PAIR('<', '>'), NULL, 3, OP_NOT_EQUAL},
    {'<', NULL, 3, OP_LESS},
    {'>', NULL, 3, OP_GREATER},
    {LEXER_PAIR('<', '='), NULL, 3, OP_LESS_EQUAL},
    {LEXER_PAIR('=', '<'), NULL, 3, OP_LESS_EQUAL},
    {LEXER_PAIR('>', '='), NULL, 3, OP_GREATER_EQUAL},
    {LEXER_PAIR('=', '>'), NULL, 3, OP_GREATER_EQUAL},
    {'=', NULL, 2, OP_EQUAL},
    {0, "AND", 1, OP_AND},
    {0, "OR", 1, OP_OR},
    {0, "XOR", 1, OP_XOR},
};

static unsigned nesting;

static void compile_at(unsigned precedence);

void expressions_start(void) {
    nesting = 0;
}

void expressions_enter(unsigned weight) {
    nesting += weight;
    if (nesting > NESTING_MAX) {
        errors_fail(ERR_TOO_COMPLEX);
    }
}

void expressions_leave(unsigned weight) {
    nesting -= weight;
}

static const operator_t *find_operator(void) {
    const lexer_token_t *token = lexer_now();
    if (token->kind != LEXER_SYMBOL && token->kind != LEXER_NAME) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof operators / sizeof operators[0]; i++) {
        const operator_t *row = &operators[i];
        bool found = row->word != NULL ? lexer_is_word(row->word) : lexer_is(row->symbol);
        if (found) {
            return row;
        }
    }
    return NULL;
}

static void enter(void) {
    expressions_enter(EXPRESSIONS_PARENTHESIS);
}

static void leave(void) {
    expressions_leave(EXPRESSIONS_PARENTHESIS);
}

unsigned expressions_compile_subscripts(void) {
    unsigned count = 0;
    lexer_expect('(');
    do {
        expressions_compile();
        count++;
    } while (lexer_take(','));
    lexer_expect(')');
    return count;
}

uint16_t expressions_compile_name(void) {
    uint8_t check_type;
    uint16_t variable = names_variable(lexer_now(), &check_type);
    if (check_type != VALUE_NONE) {
        emit_variable(OP_CHECK_TYPE, variable);
        emit_byte(check_type);
    }
    lexer_next();
    return variable;
}

// `name()` or `name(subscripts)` or `name`; leaves the value, or with `reference` a reference.
void expressions_compile_variable(bool reference, bool arrays) {
    const lexer_token_t *name = lexer_now();
    if (words_is_reserved(name->text, name->length)) {
        errors_fail(ERR_SYNTAX);
    }
    uint16_t variable = expressions_compile_name();
    if (!lexer_is('(')) {
        emit_variable(reference ? OP_REF : OP_LOAD, variable);
        return;
    }
    const char *parenthesis = lexer_now()->text;
    lexer_next();
    if (arrays && lexer_take(')')) {
        emit_variable(OP_REF_ARRAY, variable);
        return;
    }
    lexer_go(parenthesis);
    enter();
    unsigned count = expressions_compile_subscripts();
    leave();
    emit_element(reference ? OP_REF_ELEMENT : OP_LOAD_ELEMENT, variable, count);
}

static void compile_call(symbols_t *symbol) {
    emit_op(OP_BLANK);
    lexer_next();
    lexer_expect('(');
    enter();
    unsigned count = expressions_compile_arguments(')');
    leave();
    lexer_expect(')');
    emit_op(OP_CALL);
    emit_u16(memory_handle(symbol));
    emit_byte(count);
}

static void compile_name(void) {
    const lexer_token_t *name = lexer_now();
    int row = words_find(WORDS_FUNCTION, name->text, name->length);
    if (row != WORDS_NONE) {
        function_calls_compile(row);
        return;
    }
    row = words_find(WORDS_HOST_FUNCTION, name->text, name->length);
    if (row != WORDS_NONE) {
        enter();
        args_compile_function(row);
        leave();
        return;
    }
    symbols_t *symbol = symbols_find(SYMBOLS_ROUTINE, 0, name->text, lexer_bare_length(name));
    if (symbol != NULL && symbol->routine->is_function && name->behind < lexer_line_end() &&
        (*name->behind == '(' || *name->behind == ' ')) {
        uint8_t type = lexer_suffix_type(name->suffix);
        const char *behind = name->behind;
        while (behind < lexer_line_end() && *behind == ' ') {
            behind++;
        }
        if (behind < lexer_line_end() && *behind == '(') {
            uint8_t known = symbol->routine->type;
            if (type != VALUE_NONE && known != VALUE_NONE && type != known) {
                errors_fail_with(ERR_DIFFERENT_TYPE, "%s", symbol->name);
            }
            compile_call(symbol);
            return;
        }
    }
    expressions_compile_variable(false, false);
}

// Not inlined: its buffer would lie on the C stack once for each parenthesis.
__attribute__((noinline)) void expressions_compile_text(void) {
    char text[VALUE_STRING_MAX];
    emit_string(text, lexer_text(text));
    lexer_next();
}

static void compile_prefix_operator(code_op_t op) {
    lexer_next();
    if (op == OP_NEGATE && lexer_now()->kind == LEXER_NUMBER) {
        value_t value = lexer_now()->value;
        if (value.type == VALUE_INTEGER) {
            value.integer = (int64_t)(0 - (uint64_t)value.integer);
        } else {
            value.number = -value.number;
        }
        emit_constant(&value);
        lexer_next();
        return;
    }
    enter();
    compile_at(8);
    leave();
    emit_op(op);
}

// The value an expression starts with; a sign, NOT and INV belong to the value behind them.
static void compile_operand(void) {
    const lexer_token_t *token = lexer_now();
    if (token->kind == LEXER_NUMBER) {
        emit_constant(&token->value);
        lexer_next();
    } else if (token->kind == LEXER_STRING) {
        expressions_compile_text();
    } else if (lexer_is('-')) {
        compile_prefix_operator(OP_NEGATE);
    } else if (lexer_is('+')) {
        compile_prefix_operator(OP_PLUS);
    } else if (lexer_is_word("NOT")) {
        compile_prefix_operator(OP_NOT);
    } else if (lexer_is_word("INV")) {
        compile_prefix_operator(OP_INVERT);
    } else if (lexer_take('(')) {
        enter();
        compile_at(0);
        leave();
        lexer_expect(')');
        emit_forget_last(); // (a) is a value, not the variable a
    } else if (token->kind == LEXER_NAME) {
        compile_name();
    } else {
        errors_fail(ERR_SYNTAX);
    }
}

// Everything that binds at least as tightly as `precedence`.
static void compile_at(unsigned precedence) {
    expressions_enter(1);
    compile_operand();
    for (;;) {
        const operator_t *row = find_operator();
        if (row == NULL || row->precedence < precedence) {
            expressions_leave(1);
            return;
        }
        lexer_next();
        compile_at(row->precedence + 1u);
        emit_op((code_op_t)row->op);
    }
}

void expressions_compile(void) {
    compile_at(0);
}

void expressions_compile_before_equals(void) {
    compile_at(3);
}

void expressions_compile_argument(void) {
    if (lexer_now()->kind == LEXER_NAME) { // name() is a whole array
        const char *start = lexer_now()->text;
        size_t length = lexer_bare_length(lexer_now());
        bool is_routine = symbols_find(SYMBOLS_ROUTINE, 0, start, length) != NULL ||
                          words_find(WORDS_FUNCTION, start, lexer_now()->length) != WORDS_NONE ||
                          words_find(WORDS_HOST_FUNCTION, start, lexer_now()->length) != WORDS_NONE;
        lexer_next();
        bool is_array = lexer_take('(') && lexer_is(')');
        lexer_go(start);
        if (is_array && !is_routine) {
            expressions_compile_variable(false, true);
            return;
        }
    }
    emit_forget_last();
    expressions_compile();
    if (emit_last() == OP_LOAD) {
        emit_change_last(OP_REF);
    } else if (emit_last() == OP_LOAD_ELEMENT) {
        emit_change_last(OP_REF_ELEMENT);
    }
}

unsigned expressions_compile_arguments(int closing) {
    unsigned count = 0;
    bool blank = false;
    if (lexer_at_end() || lexer_is(closing)) {
        return 0;
    }
    do {
        blank = lexer_is(',') || lexer_is(closing) || lexer_at_end();
        if (blank && (count == 0 || !lexer_is(','))) {
            errors_fail(ERR_ARGUMENT_LIST);
        }
        if (blank) {
            emit_op(OP_BLANK);
        } else {
            expressions_compile_argument();
        }
        count++;
    } while (lexer_take(','));
    if (count > SYMBOLS_PARAMETERS_MAX) {
        errors_fail(ERR_ARGUMENT_LIST);
    }
    return count;
}

static void compile_reference(bool arrays) {
    if (lexer_now()->kind != LEXER_NAME) {
        errors_fail(ERR_SYNTAX);
    }
    expressions_compile_variable(true, arrays);
}

void expressions_compile_reference(void) {
    compile_reference(false);
}

void expressions_compile_reference_or_array(void) {
    compile_reference(true);
}
