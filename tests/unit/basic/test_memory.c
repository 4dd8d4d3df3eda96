// The arena's heap when blocks go in the middle of it: ERASE and REDIM.
#include "basic/memory.h"

#include <string.h>

#include <unity.h>

#include "basic/errors.h"

#define BLOCKS 60
#define ROUNDS 40000
#define LARGEST 1500

static _Alignas(8) uint8_t arena[65536];

typedef struct {
    uint8_t *place; // NULL: none
    size_t size;
    uint8_t pattern;
} block_t;

static block_t blocks[BLOCKS];
static uint8_t *start;

void setUp(void) {
    memset(blocks, 0, sizeof blocks);
    memory_start(arena, sizeof arena);
    start = memory.heap;
}

void tearDown(void) {}

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t limit) {
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) % limit;
}

// ---- Blocks -------------------------------------------------------------------------------------

static size_t wanted;
static uint8_t *got;

static void take(void) {
    got = memory_heap(wanted);
}

static bool try_take(block_t *block, size_t size) {
    wanted = size;
    if (errors_try(take) != ERRORS_NONE) {
        return false;
    }
    for (size_t i = 0; i < size; i++) {
        TEST_ASSERT_EQUAL_UINT8(0, got[i]); // as memory_heap() promises, in a hole as well
    }
    *block = (block_t){got, size, (uint8_t)(1 + random_below(255))};
    memset(got, block->pattern, size);
    return true;
}

static void check(const block_t *block) {
    for (size_t i = 0; i < block->size; i++) {
        TEST_ASSERT_EQUAL_UINT8(block->pattern, block->place[i]);
    }
}

static void give_back(block_t *block) {
    check(block);
    memory_release(block->place, block->size);
    block->place = NULL;
}

// ---- Tests --------------------------------------------------------------------------------------

static void test_a_hole_is_filled_first(void) {
    TEST_ASSERT_TRUE(try_take(&blocks[0], 100));
    TEST_ASSERT_TRUE(try_take(&blocks[1], 200));
    TEST_ASSERT_TRUE(try_take(&blocks[2], 100));
    uint8_t *hole = blocks[1].place;
    const uint8_t *end = memory.heap;
    give_back(&blocks[1]);
    TEST_ASSERT_TRUE(try_take(&blocks[1], 150));
    TEST_ASSERT_EQUAL_PTR(hole, blocks[1].place);
    TEST_ASSERT_EQUAL_PTR(end, memory.heap);
}

static void test_holes_that_meet_become_one(void) {
    for (unsigned i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(try_take(&blocks[i], 96));
    }
    uint8_t *hole = blocks[1].place;
    give_back(&blocks[1]);
    give_back(&blocks[3]);
    give_back(&blocks[2]); // between the two
    TEST_ASSERT_TRUE(try_take(&blocks[1], 3 * 96));
    TEST_ASSERT_EQUAL_PTR(hole, blocks[1].place);
}

static void test_the_last_block_makes_the_heap_shorter(void) {
    TEST_ASSERT_TRUE(try_take(&blocks[0], 40));
    TEST_ASSERT_TRUE(try_take(&blocks[1], 40));
    give_back(&blocks[0]);
    give_back(&blocks[1]);
    TEST_ASSERT_EQUAL_PTR(start, memory.heap);
}

static void test_blocks_come_and_go_at_random(void) {
    unsigned taken = 0, refused = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        block_t *block = &blocks[random_below(BLOCKS)];
        if (block->place != NULL) {
            give_back(block);
        } else if (try_take(block,
                            1 + random_below(random_below(10) == 0 ? 4 * LARGEST : LARGEST))) {
            taken++;
        } else {
            refused++;
        }
    }
    TEST_ASSERT_GREATER_THAN(ROUNDS / 4, taken);
    TEST_ASSERT_GREATER_THAN(10, refused); // the heap was full at times
    for (unsigned i = 0; i < BLOCKS; i++) {
        if (blocks[i].place != NULL) {
            give_back(&blocks[i]);
        }
    }
    TEST_ASSERT_EQUAL_PTR(start, memory.heap);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_hole_is_filled_first);
    RUN_TEST(test_holes_that_meet_become_one);
    RUN_TEST(test_the_last_block_makes_the_heap_shorter);
    RUN_TEST(test_blocks_come_and_go_at_random);
    return UNITY_END();
}
