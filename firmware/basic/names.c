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

// Where a local's name stands: its length above its offset into the source.
#define PACKED_LENGTH_SHIFT 24
#define PACKED_OFFSET_MASK 0xFFFFFFu

static struct {
    symbols_t *symbol; // of the routine; NULL outside
    const char *source;
    bool loose; // the routine is running: its locals are fixed
    local_t locals[LOCALS_MAX];
    unsigned local_count; // places in use; [0] is the routine's value
    uint8_t default_type;
} names;

void names_start(const char *source) {
    names.symbol = NULL;
    names.source = source;
    names.loose = false;
}

void names_start_loose(const symbols_routine_t *routine) {
    names.symbol = routine != NULL ? memory_place(routine->symbol) : NULL;
    names.loose = true;
}

void names_begin_routine(symbols_t *symbol) {
    names.symbol = symbol;
    names.local_count = 1;
    bool is_function = symbol->routine->is_function;
    names.locals[0] = (local_t){is_function ? symbol->name : "", is_function ? symbol->length : 0,
                                symbol->routine->type};
}

// Keeps where the names are: an error shows them, and EXECUTE finds the locals by them.
static void pack_locals(symbols_routine_t *routine) {
    uint32_t *packed = symbols_memory(names.local_count * sizeof *packed);
    for (unsigned i = 1; i < names.local_count; i++) { // [0] has the routine's name
        const local_t *local = &names.locals[i];
        if (local->length != 0) {
            packed[i] = (uint32_t)local->length << PACKED_LENGTH_SHIFT |
                        ((uint32_t)(local->text - names.source) & PACKED_OFFSET_MASK);
        }
    }
    routine->names = packed;
}

void names_end_routine(void) {
    symbols_routine_t *routine = names.symbol->routine;
    routine->locals = (uint8_t)names.local_count;
    names.symbol = NULL;
    pack_locals(routine);
}

const char *names_of_local(const symbols_routine_t *routine, unsigned index, size_t *length) {
    if (index == 0) {
        const symbols_t *symbol = memory_place(routine->symbol);
        *length = routine->is_function ? symbol->length : 0;
        return symbol->name;
    }
    uint32_t packed = index < routine->locals && routine->names != NULL ? routine->names[index] : 0;
    *length = packed >> PACKED_LENGTH_SHIFT;
    return names.source + (packed & PACKED_OFFSET_MASK);
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

static bool same_name(const char *one, size_t one_length, const char *other, size_t length) {
    return one_length == length && letters_same(one, other, length);
}

static int find_running_local(const char *text, size_t length) {
    const symbols_routine_t *routine = names.symbol->routine;
    for (unsigned i = 0; i < routine->locals; i++) {
        size_t known_length;
        const char *known = names_of_local(routine, i, &known_length);
        if (same_name(known, known_length, text, length)) {
            return (int)i;
        }
    }
    return -1;
}

static int find_local(const char *text, size_t length) {
    if (names.symbol == NULL || length == 0) {
        return -1;
    }
    if (names.loose) {
        return find_running_local(text, length);
    }
    for (unsigned i = 0; i < names.local_count; i++) {
        if (same_name(names.locals[i].text, names.locals[i].length, text, length)) {
            return (int)i;
        }
    }
    return -1;
}

static _Noreturn void fail_different(const char *text, size_t length) {
    char name[SYMBOLS_NAME_MAX + 1] = "";
    for (size_t i = 0; i < length && i < SYMBOLS_NAME_MAX; i++) {
        name[i] = letters_upper(text[i]);
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

// A SUB or FUNCTION is no variable: without parentheses the name of one would read as 0 for ever.
static void refuse_other_names(const char *text, size_t length) {
    const symbols_t *routine = symbols_find(SYMBOLS_ROUTINE, 0, text, length);
    if (routine != NULL) {
        errors_fail_with(routine->routine->is_function ? ERR_FUNCTION_CALL : ERR_SUB_NAME, "%s",
                         routine->name);
    }
    if (length > 3 && same_name(text, 3, "MM.", 3)) {
        errors_fail_with(ERR_NO_FUNCTION, "%.*s", (int)length, text);
    }
}

// The program's variable, or the routine's STATIC.
static symbols_t *find_symbol(const char *text, size_t length, bool *is_new) {
    *is_new = false;
    if (names.symbol != NULL) {
        symbols_t *own = symbols_find(SYMBOLS_VARIABLE, names_scope(), text, length);
        if (own != NULL) {
            return own;
        }
    }
    symbols_t *symbol = symbols_find(SYMBOLS_VARIABLE, 0, text, length);
    if (symbol == NULL) {
        refuse_other_names(text, length);
        *is_new = true;
        symbol = symbols_get(SYMBOLS_VARIABLE, 0, text, length);
    }
    return symbol;
}

uint16_t names_variable(const lexer_token_t *name, uint8_t *check_type) {
    size_t length = lexer_bare_length(name);
    uint8_t type = lexer_suffix_type(name->suffix);
    *check_type = VALUE_NONE;
    int local = find_local(name->text, length);
    if (local >= 0) {
        if (names.loose) {
            *check_type = type;
        } else if (type != VALUE_NONE && names.locals[local].type != type) {
            fail_different(name->text, length);
        }
        return (uint16_t)(CODE_LOCAL_FLAG | (unsigned)local);
    }
    bool is_new;
    symbols_t *symbol = find_symbol(name->text, length, &is_new);
    *check_type = settle(symbol, type, is_new);
    return memory_handle(symbol);
}

uint16_t names_global(const lexer_token_t *name, uint8_t type) {
    size_t length = lexer_bare_length(name);
    bool is_new = symbols_find(SYMBOLS_VARIABLE, 0, name->text, length) == NULL;
    if (is_new) {
        refuse_other_names(name->text, length);
    }
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

// Errors unless the routine can have a name of its own here.
static size_t check_new_name(const lexer_token_t *name) {
    size_t length = lexer_bare_length(name);
    if (names.symbol == NULL || names.loose) {
        errors_fail(ERR_INVALID_HERE);
    }
    if (length > SYMBOLS_NAME_MAX) {
        errors_fail(ERR_NAME_TOO_LONG);
    }
    if (find_local(name->text, length) >= 0 ||
        symbols_find(SYMBOLS_VARIABLE, names_scope(), name->text, length) != NULL) {
        char known[SYMBOLS_NAME_MAX + 1] = "";
        for (size_t i = 0; i < length; i++) {
            known[i] = letters_upper(name->text[i]);
        }
        errors_fail_with(ERR_ALREADY_DECLARED, "%s", known);
    }
    return length;
}

uint16_t names_local(const lexer_token_t *name, uint8_t type) {
    size_t length = check_new_name(name);
    uint16_t variable = new_places(1);
    names.locals[variable & ~CODE_LOCAL_FLAG] = (local_t){name->text, (uint8_t)length, type};
    return variable;
}

uint16_t names_static(const lexer_token_t *name) {
    size_t length = check_new_name(name);
    return memory_handle(symbols_get(SYMBOLS_VARIABLE, names_scope(), name->text, length));
}

void names_set_static_type(uint16_t variable, uint8_t type) {
    symbols_t *symbol = memory_place(variable);
    symbol->type = type;
}

uint16_t names_hidden(unsigned count) {
    if (names.symbol != NULL && !names.loose) {
        return new_places(count);
    }
    value_t *places = memory_scratch(count * sizeof(value_t)); // lives as long as the code
    for (unsigned i = 0; i < count; i++) {
        places[i].type = VALUE_NONE;
    }
    return memory_handle(places);
}
