// The arena. Context: main loop.
#include "memory.h"

#include <string.h>

#include "errors.h"

#define ALIGNMENT 8u
#define HANDLES_SIZE (32768u * ALIGNMENT)
#define BYTES_PER_VALUE 240u // of arena for each place on the stack

memory_t memory;

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
}

void memory_settle(void) {
    memory.heap = align_up(memory.heap);
    if (memory_free() < MEMORY_PROMPT_RESERVE) {
        errors_fail(ERR_NO_MEMORY);
    }
    memory.ceiling = memory.scratch - MEMORY_PROMPT_RESERVE;
}

// Takes `size` bytes of the heap.
static uint8_t *take_heap(size_t size) {
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
