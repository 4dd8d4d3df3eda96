// Waiting in virtual time: what ends a wait, and that input comes before time moves.
#include <string.h>
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"
#include "host_console.h"
#include "host_idle.h"

static struct {
    const char *to_send;
    bool ended;
    char received[256];
    size_t received_size;
} peer;

static size_t type(uint8_t *bytes, size_t size) {
    size_t count = strlen(peer.to_send) < size ? strlen(peer.to_send) : size;
    memcpy(bytes, peer.to_send, count);
    peer.to_send += count;
    return count;
}

static bool at_end(void) {
    return peer.ended;
}

static void receive(const uint8_t *bytes, size_t size) {
    TEST_ASSERT_TRUE(peer.received_size + size < sizeof peer.received);
    memcpy(peer.received + peer.received_size, bytes, size);
    peer.received_size += size;
}

static const host_console_peer_t console_peer = {type, at_end, receive};
static unsigned ticks;
static unsigned governors;

static void count_tick(void) {
    ticks++;
    if (ticks % 50 == 0) {
        hal_governor_request();
    }
}

static void count_governor(void) {
    governors++;
}

void setUp(void) {
    static uint8_t rest[64];
    fixture_reset();
    memset(&peer, 0, sizeof peer);
    peer.to_send = "";
    host_console_attach(&console_peer);
    while (hal_console_read(rest, sizeof rest) > 0) {
    }
    host_idle_init(false);
    hal_idle(0); // takes note of what the last test left
    ticks = 0;
    governors = 0;
}
void tearDown(void) {}

static void test_time_jumps_to_the_deadline(void) {
    uint64_t until_us = hal_time_us() + 3600u * 1000000u;
    hal_idle(until_us);
    TEST_ASSERT_EQUAL_UINT64(until_us, hal_time_us());
    hal_idle(until_us - 1000000);
    TEST_ASSERT_EQUAL_UINT64(until_us, hal_time_us());
}

static void test_input_comes_before_time_moves(void) {
    uint8_t bytes[8];
    uint64_t now_us = hal_time_us();
    peer.to_send = "ab";
    hal_idle(now_us + 1000);
    TEST_ASSERT_EQUAL_UINT64(now_us, hal_time_us());
    TEST_ASSERT_EQUAL_size_t(1, hal_console_read(bytes, 1));
    hal_idle(now_us + 1000); // some was taken: perhaps the rest is wanted too
    TEST_ASSERT_EQUAL_UINT64(now_us, hal_time_us());
    hal_idle(now_us + 1000); // no: what lies there is not wanted now
    TEST_ASSERT_EQUAL_UINT64(now_us + 1000, hal_time_us());
    TEST_ASSERT_EQUAL_size_t(1, hal_console_read(bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT8('b', bytes[0]);
}

static void test_output_is_sent_before_waiting(void) {
    TEST_ASSERT_EQUAL_size_t(5, hal_console_write((const uint8_t *)"hello", 5));
    TEST_ASSERT_EQUAL_size_t(0, peer.received_size);
    hal_idle(hal_time_us() + 1);
    TEST_ASSERT_EQUAL_STRING_LEN("hello", peer.received, 5);
    TEST_ASSERT_EQUAL_size_t(5, peer.received_size);
}

static void test_a_wait_ends_when_the_governor_ran(void) {
    uint64_t now_us = hal_time_us();
    fixture_core = (fixture_core_t){count_tick, count_governor};
    hal_tick_start();
    hal_idle(now_us + 100000);
    TEST_ASSERT_EQUAL_UINT64(now_us + 500, hal_time_us());
    TEST_ASSERT_EQUAL_UINT(1, governors);
}

static void test_main_gets_its_turn_every_millisecond(void) {
    uint64_t now_us = hal_time_us();
    hal_tick_start();
    hal_idle(now_us + 100000);
    TEST_ASSERT_EQUAL_UINT64(now_us + 1000, hal_time_us());
    peer.ended = true; // no peer to be patient with
    hal_idle(UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT64(now_us + 2000, hal_time_us());
}

static void test_end_of_input_comes_after_the_last_byte(void) {
    uint8_t byte;
    peer.to_send = "x";
    peer.ended = true;
    hal_idle(0);
    TEST_ASSERT_FALSE(hal_end_of_input());
    TEST_ASSERT_EQUAL_size_t(1, hal_console_read(&byte, 1));
    TEST_ASSERT_TRUE(hal_end_of_input());
}

static void wait_for_ever(void *argument) {
    (void)argument;
    peer.ended = true;
    for (int i = 0; i < 2000; i++) {
        hal_idle(UINT64_MAX);
    }
}

static void test_a_wait_that_nothing_can_end_is_given_up(void) {
    char message[200];
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(wait_for_ever, NULL, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "nothing is left that could end the wait\n"),
                                 message);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_time_jumps_to_the_deadline);
    RUN_TEST(test_input_comes_before_time_moves);
    RUN_TEST(test_output_is_sent_before_waiting);
    RUN_TEST(test_a_wait_ends_when_the_governor_ran);
    RUN_TEST(test_main_gets_its_turn_every_millisecond);
    RUN_TEST(test_end_of_input_comes_after_the_last_byte);
    RUN_TEST(test_a_wait_that_nothing_can_end_is_given_up);
    return UNITY_END();
}
