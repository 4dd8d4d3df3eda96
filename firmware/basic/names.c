// Names while compiling. Context: main loop.
#include "names.h"

#include <string.h>

#include "base/base.h"
#include "code.h"
#include "errors.h"
#include "memory.h"

#define LOCALS_MAX 64

typedef struct {
    const char *text; // in the source
    uint8_t length;
    uint8_t type; // VALUE_NONE: the default type
} local_t;

static struct {
    symbols_t *symbol; // of the routine; NULL outside
    local_t locals[LOCALS_MAX];
    unsigned local_count; // places in use; [0] is the routine's value
    uint8_t default_type;
} names;

void names_start(void) {
    names.symbol = NULL;
}

void names_begin_routine(symbols_t *symbol) {
    names.symbol = symbol;
    names.local_count = 1;
    bool is_function = symbol->routine->is_function;
    names.locals[0] = (local_t){is_function ? symbol->name : "", is_function ? symbol->length : 0,
                                symbol->routine->type};
}

void names_end_routine(void) {
    names.symbol->routine->locals = (uint8_t)names.local_count;
    names.symbol = NULL;
}

void names_set_result_type(uint8_t type) {
    names.locals[0].type = type;
}

void names_restore(symbols_t *symbol) {
    names.symbol = symbol;
}

symbols_t *names_routine(void) {
    return names.symbol;
}

uint16_t names_scope(void) {
    return names.symbol != NULL ? memory_handle(names.symbol) : 0;
}

void names_set_default_type(uint8_t type) {
    names.default_type = type;
}

uint8_t names_default_type(void) {
    return names.default_type;
}

static bool same_name(const local_t *local, const char *text, size_t length) {
    if (local->length != length) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        char a = local->text[i];
        char b = text[i];
        a = a >= 'a' && a <= 'z' ? (char)(a - 0x20) : a;
        b = b >= 'a' && b <= 'z' ? (char)(b - 0x20) : b;
        if (a != b) {
            return false;
        }
    }
    return true;
}

static int find_local(const char *text, size_t length) {
    if (names.symbol == NULL || length == 0) {
        return -1;
    }
    for (unsigned i = 0; i < names.local_count; i++) {
        if (same_name(&names.locals[i], text, length)) {
            return (int)i;
        }
    }
    return -1;
}

static _Noreturn void fail_different(const char *text, size_t length) {
    char name[SYMBOLS_NAME_MAX + 1] = "";
    for (size_t i = 0; i < length && i < SYMBOLS_NAME_MAX; i++) {
        name[i] = text[i] >= 'a' && text[i] <= 'z' ? (char)(text[i] - 0x20) : text[i];
    }
    errors_fail_with(ERR_DIFFERENT_TYPE, "%s", name);
}

// Settles the type of a program's variable as far as the source tells.
static uint8_t settle(symbols_t *symbol, uint8_t type, bool is_new) {
    if (type == VALUE_NONE || symbol->type == type) {
        return VALUE_NONE;
    }
    if (symbol->type != VALUE_NONE) {
        fail_different(symbol->name, symbol->length);
    }
    if (is_new) {
        symbol->type = type;
        return VALUE_NONE;
    }
    return type;
}

uint16_t names_variable(const lexer_token_t *name, uint8_t *check_type) {
    size_t length = lexer_bare_length(name);
    uint8_t type = lexer_suffix_type(name->suffix);
    *check_type = VALUE_NONE;
    int local = find_local(name->text, length);
    if (local >= 0) {
        if (type != VALUE_NONE && names.locals[local].type != type) {
            fail_different(name->text, length);
        }
        return (uint16_t)(CODE_LOCAL_FLAG | (unsigned)local);
    }
    symbols_t *symbol = symbols_find(SYMBOLS_VARIABLE, 0, name->text, length);
    bool is_new = symbol == NULL;
    if (is_new) {
        symbol = symbols_get(SYMBOLS_VARIABLE, 0, name->text, length);
    }
    *check_type = settle(symbol, type, is_new);
    return memory_handle(symbol);
}

uint16_t names_global(const lexer_token_t *name, uint8_t type) {
    size_t length = lexer_bare_length(name);
    bool is_new = symbols_find(SYMBOLS_VARIABLE, 0, name->text, length) == NULL;
    symbols_t *symbol = symbols_get(SYMBOLS_VARIABLE, 0, name->text, length);
    settle(symbol, type, is_new);
    return memory_handle(symbol);
}

static uint16_t new_places(unsigned count) {
    if (names.local_count + count > LOCALS_MAX) {
        errors_fail(ERR_TOO_MANY_LOCALS);
    }
    unsigned first = names.local_count;
    for (unsigned i = 0; i < count; i++) {
        names.locals[names.local_count++] = (local_t){"", 0, VALUE_NONE};
    }
    return (uint16_t)(CODE_LOCAL_FLAG | first);
}

uint16_t names_local(const lexer_token_t *name, uint8_t type) {
    if (names.symbol == NULL) {
        errors_fail(ERR_INVALID_HERE);
    }
    size_t length = lexer_bare_length(name);
    if (length > SYMBOLS_NAME_MAX) {
        errors_fail(ERR_NAME_TOO_LONG);
    }
    if (find_local(name->text, length) >= 0) {
        errors_fail_with(ERR_ALREADY_DECLARED, "%.*s", (int)length, name->text);
    }
    uint16_t variable = new_places(1);
    names.locals[variable & ~CODE_LOCAL_FLAG] = (local_t){name->text, (uint8_t)length, type};
    return variable;
}

uint16_t names_hidden(unsigned count) {
    if (names.symbol != NULL) {
        return new_places(count);
    }
    value_t *places = memory_scratch(count * sizeof(value_t)); // lives as long as the code
    for (unsigned i = 0; i < count; i++) {
        places[i].type = VALUE_NONE;
    }
    return memory_handle(places);
}
