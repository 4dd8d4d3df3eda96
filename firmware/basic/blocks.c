// Blocks being compiled. Context: main loop, while compiling.
#include "blocks.h"

#include <stddef.h>
#include <string.h>

#include "compiler.h"
#include "emit.h"
#include "errors.h"
#include "memory.h"

#define BLOCKS_MAX 100

// While something is compiled the stack of values is free from some place on: the blocks lie there.
static struct {
    blocks_t *open;
    blocks_t *saved;
    unsigned max;
    unsigned count;
    unsigned saved_count;
} blocks;

void blocks_save(void) {
    blocks.saved_count = blocks.count;
    memcpy(blocks.saved, blocks.open, blocks.count * sizeof blocks.open[0]);
}

void blocks_restore(void) {
    blocks.count = blocks.saved_count;
    memcpy(blocks.open, blocks.saved, blocks.saved_count * sizeof blocks.open[0]);
}

void blocks_start(value_t *room) {
    size_t fitting = (size_t)(memory.values_limit - room) * sizeof *room / sizeof(blocks_t) / 2;
    blocks.max = fitting < BLOCKS_MAX ? (unsigned)fitting : BLOCKS_MAX;
    blocks.open = (blocks_t *)(void *)room;
    blocks.saved = blocks.open + blocks.max;
    blocks.count = 0;
}

blocks_t *blocks_open(blocks_kind_t kind) {
    if (blocks.count == blocks.max) {
        errors_fail_with(ERR_NESTED_TOO_DEEP, "blocks");
    }
    blocks_t *block = &blocks.open[blocks.count++];
    *block = (blocks_t){.kind = kind, .opening = compiler_statement_start()};
    return block;
}

blocks_t *blocks_top(blocks_kind_t kind) {
    if (blocks.count == 0 || blocks.open[blocks.count - 1].kind != kind) {
        return NULL;
    }
    return &blocks.open[blocks.count - 1];
}

blocks_t *blocks_find(blocks_kind_t kind) {
    for (unsigned i = blocks.count; i-- > 0;) {
        if (blocks.open[i].kind == kind) {
            return &blocks.open[i];
        }
        if (blocks.open[i].kind == BLOCKS_ROUTINE) {
            break;
        }
    }
    return NULL;
}

void blocks_close(void) {
    blocks.count--;
}

static err_t error_of(blocks_kind_t kind) {
    switch (kind) {
    case BLOCKS_FOR:
        return ERR_NO_NEXT;
    case BLOCKS_DO:
        return ERR_NO_LOOP;
    case BLOCKS_IF:
        return ERR_NO_ENDIF;
    case BLOCKS_SELECT:
        return ERR_NO_END_SELECT;
    default:
        return ERR_NO_END_SUB;
    }
}

blocks_t *blocks_abandon(void) {
    while (blocks.count > 0) {
        blocks_t *block = &blocks.open[blocks.count - 1];
        if (block->kind == BLOCKS_ROUTINE) {
            return block;
        }
        blocks.count--;
        emit_patch(&block->exits);
        emit_patch(&block->next_case);
        compiler_spoil(block->opening, error_of(block->kind));
        emit_commit(); // nothing of this is taken back, and there may be more blocks than patches
    }
    return NULL;
}
