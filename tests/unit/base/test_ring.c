// The ring's indices: fill, order, every slot usable, odd sizes, and the counters' wrap at 2^32.
#include "base/base.h"

#include <unity.h>

#define SIZE_MAX_TESTED 1024

static ring_t ring;
static uint32_t slots[SIZE_MAX_TESTED];

void setUp(void) {}
void tearDown(void) {}

static void put(uint32_t value) {
    slots[ring.put_slot] = value;
    ring_put(&ring);
}

static uint32_t take(void) {
    uint32_t value = slots[ring.take_slot];
    ring_take(&ring);
    return value;
}

static void assert_fill(uint32_t used) {
    TEST_ASSERT_EQUAL_UINT32(used, ring_used(&ring));
    TEST_ASSERT_EQUAL_UINT32(ring.size - used, ring_free(&ring));
}

static void test_new_ring_is_empty(void) {
    ring_reset(&ring, 5);
    assert_fill(0);
    TEST_ASSERT_EQUAL_UINT32(5, ring_free(&ring));
}

static void fill_and_drain(uint32_t size) {
    ring_reset(&ring, size);
    uint32_t next_in = 0;
    uint32_t next_out = 0;
    for (int round = 0; round < 5; round++) {
        while (ring_free(&ring) > 0) {
            TEST_ASSERT_LESS_THAN_UINT32(size, ring.put_slot);
            put(next_in++);
        }
        assert_fill(size);
        // Leaves a rest behind, so that the next round starts at another slot.
        uint32_t rest = size / 3;
        while (ring_used(&ring) > rest) {
            TEST_ASSERT_EQUAL_UINT32(next_out++, take());
        }
    }
    TEST_ASSERT_EQUAL_UINT32(next_in - next_out, ring_used(&ring));
}

static void test_any_size_keeps_order_and_uses_every_slot(void) {
    static const uint32_t sizes[] = {1, 2, 3, 7, 32, 33, 1000, SIZE_MAX_TESTED};
    for (size_t i = 0; i < COUNT_OF_ARRAY(sizes); i++) {
        fill_and_drain(sizes[i]);
    }
}

static void test_counters_wrap(void) {
    ring_reset(&ring, 3);
    ring.written = UINT32_MAX - 1;
    ring.read = UINT32_MAX - 1;
    for (uint32_t i = 0; i < 100; i++) {
        put(i);
        put(i + 1000);
        assert_fill(2);
        TEST_ASSERT_EQUAL_UINT32(i, take());
        TEST_ASSERT_EQUAL_UINT32(i + 1000, take());
        assert_fill(0);
    }
}

static void test_reset_forgets(void) {
    ring_reset(&ring, 4);
    put(1);
    put(2);
    ring_reset(&ring, 2);
    assert_fill(0);
    TEST_ASSERT_EQUAL_UINT32(0, ring.put_slot);
    TEST_ASSERT_EQUAL_UINT32(0, ring.take_slot);
}

static void test_slots_filled_are_seen_when_they_are_published(void) {
    ring_reset(&ring, 4);
    for (uint32_t i = 0; i < 3; i++) {
        slots[ring.put_slot] = 40 + i;
        ring_fill(&ring);
        TEST_ASSERT_EQUAL_UINT32(0, ring_used(&ring));
    }
    ring_publish(&ring, 2);
    TEST_ASSERT_EQUAL_UINT32(2, ring_used(&ring));
    ring_publish(&ring, 1);
    TEST_ASSERT_EQUAL_UINT32(3, ring.put_slot);
    for (uint32_t i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_UINT32(40 + i, slots[ring.take_slot]);
        ring_take(&ring);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_new_ring_is_empty);
    RUN_TEST(test_slots_filled_are_seen_when_they_are_published);
    RUN_TEST(test_any_size_keeps_order_and_uses_every_slot);
    RUN_TEST(test_counters_wrap);
    RUN_TEST(test_reset_forgets);
    return UNITY_END();
}
