// The arena. Context: main loop.
#include "memory.h"

#include <string.h>

#include "errors.h"

#define ALIGNMENT 8u
#define HANDLES_SIZE (32768u * ALIGNMENT)
#define BYTES_PER_VALUE 160u // of arena for each place on the stack

memory_t memory;

static uint32_t first_hole; // offset of the lowest hole in the heap, 0: none

static uint8_t *align_up(uint8_t *place) {
    return place + (ALIGNMENT - (uintptr_t)place % ALIGNMENT) % ALIGNMENT;
}

void memory_start(void *arena, size_t size) {
    uint8_t *base = align_up(arena);
    size -= (size_t)(base - (uint8_t *)arena);
    if (size > HANDLES_SIZE) {
        size = HANDLES_SIZE;
    }
    memory.base = base;
    memory.top = base + size / ALIGNMENT * ALIGNMENT;
    memory.values = (value_t *)(void *)base;
    memory.values_limit = memory.values + size / BYTES_PER_VALUE;
    memory.floor = (uint8_t *)memory.values_limit;
    memory_reset(memory.floor);
}

void memory_reset(uint8_t *floor) {
    memory.heap = align_up(floor);
    memory.scratch = memory.ceiling = memory.top;
    first_hole = 0;
}

void memory_settle(void) {
    memory.heap = align_up(memory.heap);
    if (memory_free() < MEMORY_PROMPT_RESERVE) {
        errors_fail(ERR_NO_MEMORY);
    }
    memory.ceiling = memory.scratch - MEMORY_PROMPT_RESERVE;
}

// ---- Holes in the heap --------------------------------------------------------------------------

typedef struct {
    uint32_t next; // offset of the next hole above, 0: none
    uint32_t size; // bytes, of which these are the first eight
} hole_t;

static hole_t *hole_at(uint32_t offset) {
    return (hole_t *)(void *)(memory.base + offset);
}

// The first hole that is large enough gives its lower end. NULL: none is.
static uint8_t *take_hole(size_t size) {
    for (uint32_t *link = &first_hole; *link != 0; link = &hole_at(*link)->next) {
        hole_t *hole = hole_at(*link);
        if (hole->size >= size) {
            uint8_t *place = (uint8_t *)hole;
            hole_t rest = {hole->next, hole->size - (uint32_t)size};
            if (rest.size == 0) {
                *link = rest.next;
            } else {
                *link += (uint32_t)size;
                *hole_at(*link) = rest;
            }
            return place;
        }
    }
    return NULL;
}

static void join_with_next(hole_t *hole) {
    if (hole->next != 0 && memory_offset(hole) + hole->size == hole->next) {
        const hole_t *next = hole_at(hole->next);
        hole->size += next->size;
        hole->next = next->next;
    }
}

// A hole at the end of the heap is none.
static void trim_heap(void) {
    for (uint32_t *link = &first_hole; *link != 0; link = &hole_at(*link)->next) {
        if (memory.base + *link + hole_at(*link)->size == memory.heap) {
            memory.heap = memory.base + *link;
            *link = 0;
            return;
        }
    }
}

void memory_release(void *place, size_t size) {
    uint32_t offset = memory_offset(place);
    uint32_t *link = &first_hole;
    hole_t *below = NULL;
    while (*link != 0 && *link < offset) {
        below = hole_at(*link);
        link = &below->next;
    }
    hole_t *hole = place;
    *hole = (hole_t){*link, (uint32_t)((size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT)};
    *link = offset;
    join_with_next(hole);
    if (below != NULL) {
        join_with_next(below);
    }
    trim_heap();
}

// ---- Taking -------------------------------------------------------------------------------------

// Takes `size` bytes of the heap.
static uint8_t *take_heap(size_t size) {
    if (first_hole != 0 && size < HANDLES_SIZE) {
        uint8_t *hole = take_hole((size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
        if (hole != NULL) {
            return hole;
        }
    }
    size_t room = memory_free();
    uint8_t *place = memory.heap;
    if (size > room || size + ALIGNMENT > room || place + size + ALIGNMENT > memory.ceiling) {
        errors_fail(ERR_NO_MEMORY);
    }
    memory.heap = align_up(place + size);
    return place;
}

bool memory_is_passing(const void *place) {
    const uint8_t *byte = place;
    return byte >= memory.scratch && byte < memory.ceiling + MEMORY_PROMPT_RESERVE;
}

size_t memory_free(void) {
    return (size_t)(memory.scratch - memory.heap);
}

void *memory_heap(size_t size) {
    uint8_t *place = take_heap(size);
    memset(place, 0, size);
    return place;
}

void *memory_scratch(size_t size) {
    size_t room = memory_free();
    if (size > room || size + ALIGNMENT > room) {
        errors_fail(ERR_NO_MEMORY);
    }
    uint8_t *place = memory.scratch - size;
    place -= (uintptr_t)place % ALIGNMENT;
    memory.scratch = place;
    memset(place, 0, size);
    return place;
}

char *memory_heap_text(size_t size) {
    return (char *)take_heap(size);
}

char *memory_text(size_t size) {
    if (size > memory_free()) {
        errors_fail(ERR_NO_MEMORY);
    }
    memory.scratch -= size;
    return (char *)memory.scratch;
}
