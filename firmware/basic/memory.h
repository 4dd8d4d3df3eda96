// The arena: everything the interpreter remembers, without a heap of its own.
//
//   | stack of values | RUN's argument | code | heap -> ...... <- scratch | program's names |
//
// The heap grows upwards and holds what lasts until the next RUN (arrays, strings, names from the
// prompt). The scratch grows downwards and is unwound: local variables at the end of a SUB,
// temporary strings at the end of a statement. Only ERASE and REDIM give blocks of the heap back:
// such holes are filled first, and those that meet become one.
// Context: main loop.
#ifndef BASIC_MEMORY_H
#define BASIC_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "value.h"

typedef struct {
    uint8_t *base;         // of the arena; 8-aligned
    uint8_t *floor;        // where the program text starts
    uint8_t *heap;         // next byte of the heap
    uint8_t *scratch;      // lowest byte of the scratch
    uint8_t *top;          // end of the arena
    uint8_t *ceiling;      // the heap ends below: what is above is left for the prompt
    value_t *values;       // the stack
    value_t *values_limit; // one behind its last place
} memory_t;

extern memory_t memory;

// Takes the arena. What does not fit the 16-bit handles (256 KB) stays unused.
void memory_start(void *arena, size_t size);

// Forgets everything above `floor` (within the arena; rounded up) and the whole scratch.
void memory_reset(uint8_t *floor);

// Room above the heap that a program cannot use up, or nothing could be typed any more, not even
// NEW or STEPPER ESTOP: the code of a line and some texts.
#define MEMORY_PROMPT_RESERVE 4096u

// The program is compiled: aligns the heap behind its code, and sets the reserve aside below its
// names. Error: there is no room for it.
void memory_settle(void);

// Zeroed, 8-aligned. Error: not enough memory.
void *memory_heap(size_t size);
void *memory_scratch(size_t size);

// Gives a block of the heap back, which starts where memory_heap() said or 8 bytes' multiples
// behind.
void memory_release(void *place, size_t size);

// Bytes for a string, neither aligned nor zeroed (on a board clearing 256 bytes costs 1000 cycles).
char *memory_text(size_t size);
char *memory_heap_text(size_t size);

// A byte offset from the base in three bytes, and back; how code names places in code.
static inline uint32_t memory_offset(const void *place) {
    return (uint32_t)((const uint8_t *)place - memory.base);
}

// An 8-aligned place in 15 bits; how code names variables and procedures.
static inline uint16_t memory_handle(const void *place) {
    return (uint16_t)(memory_offset(place) / 8);
}

static inline void *memory_place(uint16_t handle) {
    return memory.base + (size_t)handle * 8;
}

// True if `place` is in the scratch that is unwound, not among the program's names.
bool memory_is_passing(const void *place);

// Bytes between heap and scratch.
size_t memory_free(void);

#endif
