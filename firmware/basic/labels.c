// Labels and line numbers. A jump to a label waits in the label's chain until the whole program is
// compiled. Context: main loop, while compiling.
#include "labels.h"

#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "lexer.h"
#include "memory.h"
#include "names.h"
#include "symbols.h"
#include "words.h"

// Text compiled while the program runs meets labels that have their place already.
static symbols_t *find_defined(const lexer_token_t *name) {
    symbols_t *label = symbols_find(SYMBOLS_LABEL, names_scope(), name->text, name->length);
    if (label == NULL || !label->label.defined) {
        label = symbols_find(SYMBOLS_LABEL, 0, name->text, name->length);
    }
    if (label == NULL || !label->label.defined) {
        errors_fail(name->kind == LEXER_NUMBER ? ERR_NO_LINE_NUMBER : ERR_NO_LABEL);
    }
    return label;
}

static symbols_t *label_at_hand(void) {
    const lexer_token_t *token = lexer_now();
    bool is_number = token->kind == LEXER_NUMBER && token->value.type == VALUE_INTEGER;
    if ((token->kind != LEXER_NAME && !is_number) ||
        (!is_number && words_is_reserved(token->text, token->length))) {
        errors_fail(ERR_SYNTAX);
    }
    symbols_t *label = compiler_is_loose()
                           ? find_defined(token)
                           : symbols_get(SYMBOLS_LABEL, names_scope(), token->text, token->length);
    lexer_next();
    return label;
}

static void emit_label(symbols_t *label) {
    if (compiler_is_loose()) {
        emit_place(label->label.code);
    } else {
        emit_wait(&label->label.waiting);
    }
}

// A GOTO out of EXECUTE would leave its frame behind.
void labels_jump(code_op_t op) {
    if (op == OP_JUMP && compiler_is_loose() && !compiler_at_prompt()) {
        errors_fail(ERR_INVALID_HERE);
    }
    symbols_t *label = label_at_hand();
    emit_op(op);
    emit_label(label);
}

void labels_operand(void) {
    symbols_t *label = label_at_hand();
    emit_op(OP_FLOAT); // RESTORE reads the place out of the first bytes of this constant
    emit_label(label);
    emit_place(0);
    emit_u16(0);
}

void labels_define(const char *name, size_t length) {
    symbols_t *label = symbols_get(SYMBOLS_LABEL, names_scope(), name, length);
    if (label->label.defined) {
        errors_fail_with(ERR_LABEL_TWICE, "%s", label->name);
    }
    label->label.defined = true;
    label->label.code = emit_here();
}

// ---- Chains -------------------------------------------------------------------------------------

static uint32_t failed_from; // where the code taken back starts

// Places in code taken back wait for nothing any more; the newest are at the head of a chain.
static void forget_waiting(symbols_t *label) {
    while (label->label.waiting >= failed_from) {
        label->label.waiting = code_u24(memory.base + label->label.waiting);
    }
}

void labels_forget(uint32_t place) {
    failed_from = place;
    symbols_each_of(SYMBOLS_LABEL, forget_waiting);
}

static uint32_t no_line_number_stub, no_label_stub;

// A label that a SUB names may be one of the main program.
static void resolve(symbols_t *label) {
    if (label->label.waiting == 0) {
        return;
    }
    const symbols_t *place = label;
    if (!label->label.defined && label->scope != 0) {
        place = symbols_find(SYMBOLS_LABEL, 0, label->name, label->length);
    }
    uint32_t target = label->name[0] <= '9' ? no_line_number_stub : no_label_stub;
    if (place != NULL && place->label.defined) {
        target = place->label.code;
    }
    emit_patch_to(label->label.waiting, target);
    label->label.waiting = 0;
}

void labels_resolve(uint32_t no_line_number, uint32_t no_label) {
    no_line_number_stub = no_line_number;
    no_label_stub = no_label;
    symbols_each_of(SYMBOLS_LABEL, resolve);
}
