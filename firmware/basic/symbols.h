// Names of the user: variables, SUBs and FUNCTIONs, labels. Looked up while compiling; code names
// what it found by handle, so nothing is searched while a program runs. Context: main loop.
#ifndef BASIC_SYMBOLS_H
#define BASIC_SYMBOLS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "value.h"

#define SYMBOLS_NAME_MAX 32
#define SYMBOLS_PARAMETERS_MAX 16
#define SYMBOLS_ARRAY_FLAG 0x80u // on a parameter's type: a whole array
#define SYMBOLS_VALUE_FLAG 0x40u // a copy, whatever the argument is (BYVAL)

typedef enum { SYMBOLS_VARIABLE, SYMBOLS_ROUTINE, SYMBOLS_LABEL } symbols_kind_t;

// A SUB or FUNCTION.
typedef struct {
    uint32_t code; // offset of its first statement
    uint8_t is_function;
    uint8_t type; // of a FUNCTION's value: VALUE_FLOAT, _INTEGER, _STRING
    uint8_t parameters;
    uint8_t locals; // places on the stack: the value, the parameters, LOCALs, loops
    uint8_t parameter_types[SYMBOLS_PARAMETERS_MAX]; // with the flags
    uint16_t symbol;                                 // handle of its name
    const uint32_t *names; // of the locals, as names.c packs them; NULL until its end is compiled
} symbols_routine_t;

// Where a label stands and the places in code that wait to be told, chained through their operands.
typedef struct {
    uint32_t code;
    uint32_t waiting;
    bool defined;
} symbols_label_t;

typedef struct {
    union {
        value_t value; // a variable; first, so that its handle is the symbol's
        symbols_routine_t *routine;
        symbols_label_t label;
    };
    uint16_t next;  // handle of the next one in the bucket, 0 at the end
    uint16_t scope; // a label or a STATIC in a SUB: handle of the SUB
    uint8_t kind;
    uint8_t type; // the type its suffix or DIM gave it while compiling; VALUE_NONE: not said
    uint8_t length;
    char name[]; // in capitals
} symbols_t;

// Forgets all names.
void symbols_clear(void);

// New names go to the top of the arena (true: a program's, compiled while nothing runs) or the
// heap.
void symbols_set_program_mode(bool program);

// Finds a name (without suffix, any case); NULL if there is none.
symbols_t *symbols_find(symbols_kind_t kind, uint16_t scope, const char *name, size_t length);

// The same, and makes it if there is none. Errors: name too long, not enough memory.
symbols_t *symbols_get(symbols_kind_t kind, uint16_t scope, const char *name, size_t length);

// Zeroed memory that lives as long as the names do.
void *symbols_memory(size_t size);

// Calls `visit` for every name.
void symbols_each(void (*visit)(symbols_t *symbol));

// The same for the names of one kind.
void symbols_each_of(symbols_kind_t kind, void (*visit)(symbols_t *symbol));

#endif
