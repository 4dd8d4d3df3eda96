// Indices of a ring with one writer and one reader, who may live in different contexts.
// The slots belong to the owner; this keeps only who may touch which. Indices run freely and wrap
// at 2^32, so every slot can be used and `written - read` is the fill; a size need not be a power
// of two as long as it is at most RING_MAX_SIZE, because each side keeps its own slot number beside
// its count. Context: `ring_put`, `_fill` and `_publish` in the writer's, `ring_take` in the
// reader's, the counts in any.
#ifndef BASE_RING_H
#define BASE_RING_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t size; // slots in use by this ring, >= 1; changed only while both sides are still
    volatile uint32_t written; // slots ever published; writer
    volatile uint32_t read;    // slots ever released; reader
    uint32_t put_slot;         // slot number of `written`; writer
    uint32_t take_slot;        // slot number of `read`; reader
} ring_t;

// The compiler may not move memory accesses across this. On one core that is all a ring needs.
#define RING_BARRIER() __asm volatile("" ::: "memory")

static inline void ring_reset(ring_t *ring, uint32_t size) {
    *ring = (ring_t){.size = size};
}

static inline uint32_t ring_used(const ring_t *ring) {
    return ring->written - ring->read;
}

static inline uint32_t ring_free(const ring_t *ring) {
    return ring->size - ring_used(ring);
}

// The writer has filled the slot `put_slot` and goes on to the next; the reader does not see it
// yet.
static inline void ring_fill(ring_t *ring) {
    ring->put_slot = ring->put_slot + 1 < ring->size ? ring->put_slot + 1 : 0;
}

// Publishes this many slots that were filled.
static inline void ring_publish(ring_t *ring, uint32_t filled) {
    RING_BARRIER();
    ring->written = ring->written + filled;
}

// Publishes the slot `put_slot`, which the writer has filled.
static inline void ring_put(ring_t *ring) {
    ring_fill(ring);
    ring_publish(ring, 1);
}

// Gives the slot `take_slot` back to the writer.
static inline void ring_take(ring_t *ring) {
    RING_BARRIER();
    ring->take_slot = ring->take_slot + 1 < ring->size ? ring->take_slot + 1 : 0;
    ring->read = ring->read + 1;
}

#endif
