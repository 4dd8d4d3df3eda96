// Runs code. Calls of SUBs and FUNCTIONs are frames of its own, not of C: however deep a program
// calls itself, the C stack stays where it is. Context: main loop.
#ifndef BASIC_VM_H
#define BASIC_VM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"
#include "memory.h"
#include "symbols.h"
#include "value.h"

#define VM_FRAMES_MAX 128 // calls and GOSUBs under way

// What the running statement leaves for the prompt to do once nothing runs any more.
typedef enum {
    VM_REQUEST_NONE,
    VM_REQUEST_RUN,
    VM_REQUEST_NEW,
    VM_REQUEST_LOAD,
    VM_REQUEST_AUTOSAVE,
    VM_REQUEST_APPEND, // AUTOSAVE APPEND
    VM_REQUEST_RECEIVE,
    VM_REQUEST_EDIT,
} vm_request_t;

typedef enum { VM_ERROR_ABORT, VM_ERROR_IGNORE, VM_ERROR_SKIP } vm_on_error_t;

typedef struct {
    const uint8_t *return_pc;
    const uint8_t *statement;
    value_t *locals;
    value_t *operands;
    uint8_t *scratch;
    uint8_t *scratch_base;
    const symbols_routine_t *routine; // NULL: a GOSUB; or a mark of calls.h
} vm_frame_t;

typedef struct {
    const uint8_t *pc;        // while a function outside vm.c runs
    value_t *sp;              // first free place of the stack; likewise
    value_t *locals;          // of the routine that runs; [0] is the FUNCTION's value
    value_t *operands;        // where the stack is at the start of a statement
    uint8_t *scratch_base;    // where the scratch is at the start of a statement
    const uint8_t *statement; // its OP_STATEMENT
    unsigned depth;           // frames in use
    unsigned interrupt_depth; // `depth` while the SUB of an event is under way; 0: none is
    vm_frame_t frames[VM_FRAMES_MAX];

    uint8_t default_type; // OPTION DEFAULT; VALUE_NONE: must be said
    uint8_t base;         // OPTION BASE
    bool explicit_names;  // OPTION EXPLICIT
    bool escapes;         // OPTION ESCAPE, for the prompt and EXECUTE
    bool degrees;         // OPTION ANGLE DEGREES
    vm_on_error_t on_error;
    unsigned skip_count; // statements that ON ERROR SKIP still covers
    bool stop;           // leave the loop after this statement
    bool at_end;         // the code has come to its end, or to END
    vm_request_t request;
    err_t error_code;                  // of the error below
    char error_text[ERR_MESSAGE_SIZE]; // MM.ERRMSG$; empty: no error
    void (*on_clear)(void);            // never NULL
} vm_t;

extern vm_t vm;

// Forgets calls, options and ON ERROR, as at RUN.
void vm_reset(void);

// Runs `code` until it ends. ERR_OK, or the error, which err_message() tells; vm.statement is
// where. `broken` becomes true if Ctrl-C ended it.
err_t vm_run(const uint8_t *code, bool *broken);

// Source line of the statement at hand; 0: typed at the prompt.
unsigned vm_line(void);

#endif
