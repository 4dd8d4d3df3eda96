// Names of the user, hashed. Context: main loop.
#include "symbols.h"

#include <string.h>

#include "errors.h"
#include "memory.h"

#define BUCKETS 64u

static struct {
    uint16_t buckets[BUCKETS];
    bool program_mode;
} symbols;

static unsigned bucket_of(symbols_kind_t kind, const char *name, size_t length) {
    unsigned hash = (unsigned)kind;
    for (size_t i = 0; i < length; i++) {
        hash = hash * 31 + (unsigned char)letters_upper(name[i]);
    }
    return (hash ^ hash >> 6) % BUCKETS;
}

void symbols_clear(void) {
    memset(symbols.buckets, 0, sizeof symbols.buckets);
}

void symbols_set_program_mode(bool program) {
    symbols.program_mode = program;
}

static bool has_name(const symbols_t *symbol, const char *name, size_t length) {
    return symbol->length == length && letters_same(symbol->name, name, length);
}

symbols_t *symbols_find(symbols_kind_t kind, uint16_t scope, const char *name, size_t length) {
    uint16_t handle = symbols.buckets[bucket_of(kind, name, length)];
    while (handle != 0) {
        symbols_t *symbol = memory_place(handle);
        if (symbol->kind == kind && symbol->scope == scope && has_name(symbol, name, length)) {
            return symbol;
        }
        handle = symbol->next;
    }
    return NULL;
}

void *symbols_memory(size_t size) {
    return symbols.program_mode ? memory_scratch(size) : memory_heap(size);
}

symbols_t *symbols_get(symbols_kind_t kind, uint16_t scope, const char *name, size_t length) {
    symbols_t *symbol = symbols_find(kind, scope, name, length);
    if (symbol != NULL) {
        return symbol;
    }
    if (length > SYMBOLS_NAME_MAX) {
        errors_fail(ERR_NAME_TOO_LONG);
    }
    symbol = symbols_memory(sizeof *symbol + length + 1);
    symbol->kind = (uint8_t)kind;
    symbol->scope = scope;
    symbol->type = VALUE_NONE;
    symbol->length = (uint8_t)length;
    for (size_t i = 0; i < length; i++) {
        symbol->name[i] = letters_upper(name[i]);
    }
    if (kind == SYMBOLS_VARIABLE) {
        symbol->value.type = VALUE_NONE;
    }
    uint16_t *bucket = &symbols.buckets[bucket_of(kind, name, length)];
    symbol->next = *bucket;
    *bucket = memory_handle(symbol);
    return symbol;
}

#define ANY_KIND (-1)

static void each(int kind, void (*visit)(symbols_t *symbol)) {
    for (unsigned i = 0; i < BUCKETS; i++) {
        for (uint16_t handle = symbols.buckets[i]; handle != 0;) {
            symbols_t *symbol = memory_place(handle);
            handle = symbol->next;
            if (kind == ANY_KIND || symbol->kind == kind) {
                visit(symbol);
            }
        }
    }
}

void symbols_each(void (*visit)(symbols_t *symbol)) {
    each(ANY_KIND, visit);
}

void symbols_each_of(symbols_kind_t kind, void (*visit)(symbols_t *symbol)) {
    each((int)kind, visit);
}
