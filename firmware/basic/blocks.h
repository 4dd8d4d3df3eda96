// Blocks being compiled: FOR, DO, IF, SELECT CASE, and the routine around them. Context: main loop,
// while compiling.
#ifndef BASIC_BLOCKS_H
#define BASIC_BLOCKS_H

#include <stdbool.h>
#include <stdint.h>

#include "value.h"

typedef enum { BLOCKS_FOR, BLOCKS_DO, BLOCKS_IF, BLOCKS_SELECT, BLOCKS_ROUTINE } blocks_kind_t;

typedef struct {
    blocks_kind_t kind;
    uint32_t opening;   // the statement that opened it
    uint32_t body;      // where it starts over
    uint32_t exits;     // jumps behind the block
    uint32_t next_case; // jumps to the next ELSE, CASE or to the test of a loop
    uint16_t variable;  // of FOR
    uint16_t hidden;    // limit and step of FOR, value of SELECT CASE
    bool seen_else;
} blocks_t;

// No blocks are open. They are kept from `room` on, where the stack of values is free.
void blocks_start(value_t *room);

// Opens a block. Error: nested too deep.
blocks_t *blocks_open(blocks_kind_t kind);

// The innermost block if it is of this kind, otherwise NULL.
blocks_t *blocks_top(blocks_kind_t kind);

// The innermost open loop of this kind, whatever stands inside it; NULL: none in this routine.
blocks_t *blocks_find(blocks_kind_t kind);

// Closes the innermost block.
void blocks_close(void);

// Remembers the open blocks, and goes back to what was remembered after a statement that failed.
void blocks_save(void);
void blocks_restore(void);

// Closes blocks that were left open, down to the routine around them (or all, if there is none);
// their opening statements raise an error. Returns the routine's block or NULL.
blocks_t *blocks_abandon(void);

#endif
