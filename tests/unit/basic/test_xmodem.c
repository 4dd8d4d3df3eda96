// XMODEM against a peer with named faults, in virtual time. What arrives must be what was sent, or
// there must be an error; in no case anything else.
#include <stdio.h>
#include <string.h>

#include <unity.h>

#include "basic/console.h"
#include "basic/xmodem.h"
#include "board.h"
#include "peer.h"

static struct {
    uint8_t bytes[PEER_DATA_MAX];
    size_t length;
    size_t full_at; // the sink fails here; 0: never
} mine;

static uint8_t buffer[XMODEM_BUFFER_SIZE];

void setUp(void) {
    board_reset();
    board_start(NULL, 0, NULL, 0);
    board_shown();
    memset(&mine, 0, sizeof mine);
    peer_start();
}
void tearDown(void) {}

// ---- We receive ---------------------------------------------------------------------------------

static err_t sink(const void *bytes, size_t size) {
    if (mine.full_at != 0 && mine.length + size > mine.full_at) {
        return err_raise(ERR_ARGUMENT, "Disk full");
    }
    TEST_ASSERT_LESS_OR_EQUAL_size_t(PEER_DATA_MAX, mine.length + size);
    memcpy(mine.bytes + mine.length, bytes, size);
    mine.length += size;
    return ERR_OK;
}

static err_t receive(size_t length) {
    peer.length = length;
    board.on_write = peer_hear_answers;
    board_type_at(3600000000u, "\r"); // input does not end before
    return xmodem_receive(sink, buffer);
}

static void expect_all(void) {
    TEST_ASSERT_EQUAL_size_t(peer.length, mine.length);
    TEST_ASSERT_EQUAL_INT(0, memcmp(peer.data, mine.bytes, peer.length));
    TEST_ASSERT_FALSE(console_has_input());
}

static void test_all_lengths_arrive(void) {
    static const size_t lengths[] = {0, 1, 127, 128, 129, 1000, 1024, 1025, 300 * 128, 12345};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        for (size_t block_size = 128; block_size <= 1024; block_size *= 8) {
            setUp();
            peer.block_size = block_size;
            peer.data[lengths[i] > 0 ? lengths[i] - 1 : 0] = 'x';
            TEST_ASSERT_EQUAL_INT(ERR_OK, receive(lengths[i]));
            expect_all();
        }
    }
}

static void test_block_numbers_start_over_after_255(void) {
    memset(peer.data, 'y', sizeof peer.data);
    for (size_t i = 0; i < 300; i++) {
        peer.data[i * 128] = (uint8_t)(i % 251); // block 256 + n is not block n
    }
    TEST_ASSERT_EQUAL_INT(ERR_OK, receive(300 * 128));
    expect_all();
}

static void test_padding_goes_and_the_same_byte_inside_stays(void) {
    memset(peer.data + 100, PEER_PADDING, 200);
    TEST_ASSERT_EQUAL_INT(ERR_OK, receive(450));
    expect_all();
}

static void test_every_passing_fault_is_overcome(void) {
    static const peer_fault_t faults[] = {
        PEER_LATE,           PEER_CHECKSUM_ONLY, PEER_NOISE_FIRST,
        PEER_DAMAGED,        PEER_BYTE_LOST,     PEER_BYTE_ADDED,
        PEER_NUMBER_DAMAGED, PEER_ANSWER_LOST,   PEER_CANCELS_ONCE_ONLY};
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        for (unsigned block = 0; block < 8; block++) {
            if (faults[i] == PEER_NOISE_FIRST && block > 0) {
                continue;
            }
            setUp();
            peer.fault = faults[i];
            peer.fault_block = block;
            char what[40];
            snprintf(what, sizeof what, "fault %u in block %u", (unsigned)faults[i], block);
            TEST_ASSERT_EQUAL_INT_MESSAGE(ERR_OK, receive(1001), what);
            TEST_ASSERT_EQUAL_size_t_MESSAGE(1001, mine.length, what);
            expect_all();
        }
    }
}

static void test_a_block_that_does_not_come_is_asked_for(void) {
    peer.fault = PEER_BLOCK_LOST;
    peer.fault_block = 3;
    TEST_ASSERT_EQUAL_INT(ERR_OK, receive(1000));
    expect_all();
}

static void expect_failure(const char *message) {
    TEST_ASSERT_EQUAL_STRING(message, err_message());
    TEST_ASSERT_FALSE(console_has_input());
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(2, peer.cancels);
    TEST_ASSERT_EQUAL_INT(0, memcmp(peer.data, mine.bytes, mine.length)); // no wrong byte before
}

static void test_faults_that_stay_end_the_transfer(void) {
    static const struct {
        peer_fault_t fault;
        const char *message;
    } rows[] = {
        {PEER_DAMAGED_ALWAYS, "Transfer failed: too many errors"},
        {PEER_BLOCK_SKIPPED, "Transfer failed: a block is missing"},
        {PEER_CANCELS, "Transfer failed: cancelled"},
        {PEER_USER_BREAK, "Transfer failed: cancelled"},
        {PEER_DIES, "Transfer failed: too many errors"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        peer.fault = rows[i].fault;
        peer.fault_block = 3;
        TEST_ASSERT_NOT_EQUAL_INT(ERR_OK, receive(1000));
        expect_failure(rows[i].message);
        TEST_ASSERT_EQUAL_size_t(3 * 128, mine.length);
    }
}

static void test_nobody_there(void) {
    board_type_at(3600000000u, "\r");
    TEST_ASSERT_NOT_EQUAL_INT(ERR_OK, xmodem_receive(sink, buffer));
    TEST_ASSERT_EQUAL_STRING("Transfer failed: no answer", err_message());
    TEST_ASSERT_LESS_THAN_UINT64(180000000, board.time_us);
}

static void test_a_sink_that_fails_cancels(void) {
    mine.full_at = 500;
    TEST_ASSERT_NOT_EQUAL_INT(ERR_OK, receive(1000));
    expect_failure("Disk full");
}

// ---- We send ------------------------------------------------------------------------------------

static size_t given;

static err_t source(void *bytes, size_t size, size_t *got) {
    size_t left = peer.length - given;
    *got = left < size ? left : size;
    memcpy(bytes, peer.data + given, *got);
    given += *got;
    return ERR_OK;
}

static err_t send(size_t length) {
    given = 0;
    peer.length = length;
    board.on_write = peer_hear_blocks;
    const char *ask = peer.fault == PEER_CHECKSUM_ONLY ? "\x15"
                      : peer.fault == PEER_LATE_ANSWER ? "CCC"
                                                       : "C";
    board_type_at(2000000, ask);
    board_type_at(3600000000u, "\r");
    return xmodem_send(source, buffer);
}

static void test_what_is_sent_is_heard(void) {
    static const size_t lengths[] = {0, 1, 127, 128, 129, 1000, 300 * 128};
    static const peer_fault_t faults[] = {PEER_NO_FAULT, PEER_CHECKSUM_ONLY, PEER_DAMAGED,
                                          PEER_ANSWER_LOST, PEER_LATE_ANSWER};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0] * 5; i++) {
        setUp();
        peer.fault = faults[i % 5];
        peer.fault_block = 2;
        TEST_ASSERT_EQUAL_INT(ERR_OK, send(lengths[i / 5]));
        TEST_ASSERT_TRUE(peer.ended);
        TEST_ASSERT_EQUAL_size_t((peer.length + 127) / 128 * 128, peer.heard_length);
        TEST_ASSERT_EQUAL_INT(0, memcmp(peer.data, peer.heard, peer.length));
        for (size_t k = peer.length; k < peer.heard_length; k++) {
            TEST_ASSERT_EQUAL_UINT8(PEER_PADDING, peer.heard[k]);
        }
    }
}

static void test_a_receiver_that_gives_up(void) {
    static const struct {
        peer_fault_t fault;
        const char *message;
    } rows[] = {
        {PEER_DAMAGED_ALWAYS, "Transfer failed: no answer"},
        {PEER_CANCELS, "Transfer failed: cancelled"},
        {PEER_DIES, "Transfer failed: no answer"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        peer.fault = rows[i].fault;
        peer.fault_block = 3;
        TEST_ASSERT_NOT_EQUAL_INT(ERR_OK, send(1000));
        TEST_ASSERT_EQUAL_STRING(rows[i].message, err_message());
        TEST_ASSERT_FALSE(peer.ended);
    }
}

static void test_the_console_is_as_before(void) {
    peer.fault = PEER_CANCELS;
    receive(1000);
    board.on_write = NULL;
    board_type_at(board.time_us + 1000, "\x03");
    board_session("DO:LOOP\r");
    TEST_ASSERT_EQUAL_UINT(1, board.breaks);
}

static void test_a_terminal_that_takes_nothing_does_not_hold_for_ever(void) {
    board.blocked_until_us = 3000000000u;
    board_type_at(3600000000u, "\r");
    TEST_ASSERT_NOT_EQUAL_INT(ERR_OK, xmodem_receive(sink, buffer));
    TEST_ASSERT_LESS_THAN_UINT64(600000000, board.time_us);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_all_lengths_arrive);
    RUN_TEST(test_block_numbers_start_over_after_255);
    RUN_TEST(test_padding_goes_and_the_same_byte_inside_stays);
    RUN_TEST(test_every_passing_fault_is_overcome);
    RUN_TEST(test_a_block_that_does_not_come_is_asked_for);
    RUN_TEST(test_faults_that_stay_end_the_transfer);
    RUN_TEST(test_nobody_there);
    RUN_TEST(test_a_sink_that_fails_cancels);
    RUN_TEST(test_what_is_sent_is_heard);
    RUN_TEST(test_a_receiver_that_gives_up);
    RUN_TEST(test_the_console_is_as_before);
    RUN_TEST(test_a_terminal_that_takes_nothing_does_not_hold_for_ever);
    return UNITY_END();
}
