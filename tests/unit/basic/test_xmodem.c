// XMODEM against a peer with named faults, in virtual time. What arrives must be what was sent, or
// there must be an error; in no case anything else.
#include <stdio.h>
#include <string.h>

#include <unity.h>

#include "basic/console.h"
#include "basic/xmodem.h"
#include "board.h"

#define SOH 0x01
#define STX 0x02
#define EOT 0x04
#define ACK 0x06
#define NAK 0x15
#define CAN 0x18
#define SUB 0x1A
#define DATA_MAX 20000

typedef enum {
    NO_FAULT,
    LATE,              // starts after 20 s
    CHECKSUM_ONLY,     // knows no CRC
    NOISE_FIRST,       // garbage before the first block
    DAMAGED,           // one byte of a block is wrong, once
    DAMAGED_ALWAYS,    // and again each time
    BYTE_LOST,         // a block lacks a byte, once
    BYTE_ADDED,        // a block has one too many, once
    BLOCK_LOST,        // does not come, once
    NUMBER_DAMAGED,    // the block's number is wrong, once
    ANSWER_LOST,       // the peer does not hear an ACK, or we do not hear its
    BLOCK_SKIPPED,     // goes on with the next but one
    CANCELS,           // in the middle
    CANCELS_ONCE_ONLY, // a single CAN: noise
    USER_BREAK,        // somebody types Ctrl-C in the middle
    DIES,              // says nothing more
    LATE_ANSWER,       // asks several times before we listen
} fault_t;

static struct {
    fault_t fault;
    unsigned fault_block; // from 0
    bool done_fault;
    uint8_t data[DATA_MAX];
    size_t length;
    size_t block_size;
    unsigned block;
    bool started, ended;
    uint8_t heard[DATA_MAX]; // by the peer as receiver
    size_t heard_length;
    uint8_t frame[1100];
    size_t frame_length;
    unsigned cancels;
} peer;

static struct {
    uint8_t bytes[DATA_MAX];
    size_t length;
    size_t full_at; // the sink fails here; 0: never
} mine;

static uint8_t buffer[XMODEM_BUFFER_SIZE];

void setUp(void) {
    board_reset();
    board_start(NULL, 0, NULL, 0);
    board_shown();
    memset(&peer, 0, sizeof peer);
    memset(&mine, 0, sizeof mine);
    peer.block_size = 128;
    for (size_t i = 0; i < DATA_MAX; i++) {
        peer.data[i] = (uint8_t)(i * 7 + i / 251);
    }
}
void tearDown(void) {}

static unsigned crc16(const uint8_t *bytes, size_t size) { // by the definition: a division
    unsigned remainder = 0;
    for (size_t i = 0; i < size * 8 + 16; i++) {
        unsigned bit = i < size * 8 ? (unsigned)bytes[i / 8] >> (7 - i % 8) & 1u : 0;
        unsigned carry = remainder & 0x8000u;
        remainder = (remainder << 1 | bit) & 0xFFFFu;
        remainder ^= carry ? 0x1021u : 0;
    }
    return remainder;
}

// ---- The peer as sender --------------------------------------------------------------------------

static bool fault_now(fault_t fault) {
    bool now = peer.fault == fault && peer.block == peer.fault_block && !peer.done_fault;
    peer.done_fault |= now;
    return now;
}

static void put_block(void) {
    size_t start = peer.block * peer.block_size;
    if (start >= peer.length) {
        board_type("\x04", 1);
        peer.ended = true;
        return;
    }
    uint8_t frame[1100];
    size_t used = peer.length - start < peer.block_size ? peer.length - start : peer.block_size;
    frame[0] = peer.block_size == 128 ? SOH : STX;
    frame[1] = (uint8_t)(peer.block + 1 + (fault_now(NUMBER_DAMAGED) ? 4 : 0));
    frame[2] = (uint8_t)~(peer.block + 1);
    memset(frame + 3, SUB, peer.block_size);
    memcpy(frame + 3, peer.data + start, used);
    size_t size = 3 + peer.block_size;
    if (peer.fault == CHECKSUM_ONLY) {
        unsigned sum = 0;
        for (size_t i = 3; i < size; i++) {
            sum += frame[i];
        }
        frame[size++] = (uint8_t)sum;
    } else {
        unsigned crc = crc16(frame + 3, peer.block_size);
        frame[size++] = (uint8_t)(crc >> 8);
        frame[size++] = (uint8_t)crc;
    }
    bool again = peer.fault == DAMAGED_ALWAYS && peer.block == peer.fault_block;
    if (fault_now(DAMAGED) || again) {
        frame[50] ^= 0x10;
    }
    if (fault_now(BYTE_LOST)) {
        memmove(frame + 20, frame + 21, size - 21);
        size--;
    }
    if (fault_now(BYTE_ADDED)) {
        memmove(frame + 21, frame + 20, size - 20);
        size++;
    }
    if (!fault_now(BLOCK_LOST)) {
        board_type((const char *)frame, size);
    }
}

static void start_sending(uint8_t byte) {
    if (byte == 'C' && peer.fault == CHECKSUM_ONLY) {
        return;
    }
    if (peer.fault == LATE && board.time_us < 20000000) {
        return;
    }
    if (byte == 'C' || byte == NAK) {
        if (fault_now(NOISE_FIRST)) {
            board_type("login: ", 7);
            return;
        }
        peer.started = true;
        put_block();
    }
}

static void hear_answer(uint8_t byte) {
    peer.cancels += byte == CAN;
    if (!peer.started) {
        start_sending(byte);
        return;
    }
    if (peer.ended || peer.cancels > 0) {
        return;
    }
    if (byte == ACK && fault_now(ANSWER_LOST)) {
        put_block(); // once more, as after a time without an answer
        return;
    }
    peer.block += byte == ACK;
    if (byte != ACK && byte != NAK) {
        return;
    }
    if (fault_now(CANCELS)) {
        board_type("\x18\x18\x18", 3);
    } else if (fault_now(USER_BREAK)) {
        board_type("\x03", 1);
    } else if (peer.fault != DIES || peer.block < peer.fault_block) {
        if (fault_now(CANCELS_ONCE_ONLY)) {
            board_type("\x18", 1);
            return;
        }
        peer.block += fault_now(BLOCK_SKIPPED);
        put_block();
    }
}

static void hear_answers(const uint8_t *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        hear_answer(bytes[i]);
    }
}

// ---- We receive ----------------------------------------------------------------------------------

static err_t sink(const void *bytes, size_t size) {
    if (mine.full_at != 0 && mine.length + size > mine.full_at) {
        return err_raise(ERR_ARGUMENT, "Disk full");
    }
    TEST_ASSERT_LESS_OR_EQUAL_size_t(DATA_MAX, mine.length + size);
    memcpy(mine.bytes + mine.length, bytes, size);
    mine.length += size;
    return ERR_OK;
}

static err_t receive(size_t length) {
    peer.length = length;
    board.on_write = hear_answers;
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
        if (lengths[i] > DATA_MAX) {
            continue;
        }
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
    peer.block_size = 128;
    memset(peer.data, 'y', sizeof peer.data);
    for (size_t i = 0; i < 156; i++) {
        peer.data[i * 128] = (uint8_t)i;
    }
    TEST_ASSERT_EQUAL_INT(ERR_OK, receive(19968));
    expect_all();
}

static void test_padding_goes_and_the_same_byte_inside_stays(void) {
    memset(peer.data + 100, SUB, 200);
    TEST_ASSERT_EQUAL_INT(ERR_OK, receive(450));
    expect_all();
}

static void test_every_passing_fault_is_overcome(void) {
    static const fault_t faults[] = {LATE,           CHECKSUM_ONLY, NOISE_FIRST,
                                     DAMAGED,        BYTE_LOST,     BYTE_ADDED,
                                     NUMBER_DAMAGED, ANSWER_LOST,   CANCELS_ONCE_ONLY};
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        for (unsigned block = 0; block < 8; block++) {
            if (faults[i] == NOISE_FIRST && block > 0) {
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
    peer.fault = BLOCK_LOST;
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
        fault_t fault;
        const char *message;
    } rows[] = {
        {DAMAGED_ALWAYS, "Transfer failed: too many errors"},
        {BLOCK_SKIPPED, "Transfer failed: a block is missing"},
        {CANCELS, "Transfer failed: cancelled"},
        {USER_BREAK, "Transfer failed: cancelled"},
        {DIES, "Transfer failed: too many errors"},
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

// ---- The peer as receiver ------------------------------------------------------------------------

static void answer(uint8_t byte) {
    board_type((const char *)&byte, 1);
}

static void judge_block(void) {
    size_t end = 3 + 128;
    bool good = (peer.frame[1] ^ peer.frame[2]) == 0xFF;
    if (peer.fault == CHECKSUM_ONLY) {
        unsigned sum = 0;
        for (size_t i = 3; i < end; i++) {
            sum += peer.frame[i];
        }
        good &= peer.frame[end] == (uint8_t)sum;
    } else {
        good &=
            crc16(peer.frame + 3, 128) == (unsigned)(peer.frame[end] << 8 | peer.frame[end + 1]);
    }
    TEST_ASSERT_TRUE(good);
    bool repeated = peer.frame[1] == (uint8_t)peer.block && peer.block > 0;
    if (!repeated) {
        TEST_ASSERT_EQUAL_UINT8(peer.block + 1, peer.frame[1]);
    }
    bool damaged = fault_now(DAMAGED) || fault_now(LATE_ANSWER) ||
                   (peer.fault == DAMAGED_ALWAYS && peer.block == peer.fault_block);
    if (damaged) {
        answer(NAK);
        return;
    }
    if (fault_now(CANCELS)) {
        board_type("\x18\x18", 2);
        return;
    }
    if (peer.fault == DIES && peer.block == peer.fault_block) {
        return;
    }
    if (!repeated) {
        memcpy(peer.heard + peer.heard_length, peer.frame + 3, 128);
        peer.heard_length += 128;
        peer.block++;
    }
    if (peer.fault == ANSWER_LOST && peer.block == peer.fault_block + 1 && !peer.done_fault) {
        peer.done_fault = true;
        return;
    }
    answer(ACK);
}

static void hear_blocks(const uint8_t *bytes, size_t size) {
    size_t frame_size = 3 + 128 + (peer.fault == CHECKSUM_ONLY ? 1 : 2);
    for (size_t i = 0; i < size; i++) {
        peer.cancels += peer.frame_length == 0 && bytes[i] == CAN;
        if (peer.frame_length == 0 && bytes[i] == EOT) {
            peer.ended = true;
            answer(ACK);
        } else if (peer.frame_length > 0 || bytes[i] == SOH) {
            peer.frame[peer.frame_length++] = bytes[i];
            if (peer.frame_length == frame_size) {
                peer.frame_length = 0;
                judge_block();
            }
        }
    }
}

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
    board.on_write = hear_blocks;
    const char *ask = peer.fault == CHECKSUM_ONLY ? "\x15"
                      : peer.fault == LATE_ANSWER ? "CCC"
                                                  : "C";
    board_type_at(2000000, ask);
    board_type_at(3600000000u, "\r");
    return xmodem_send(source, buffer);
}

static void test_what_is_sent_is_heard(void) {
    static const size_t lengths[] = {0, 1, 127, 128, 129, 1000, 12800};
    static const fault_t faults[] = {NO_FAULT, CHECKSUM_ONLY, DAMAGED, ANSWER_LOST, LATE_ANSWER};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0] * 5; i++) {
        setUp();
        peer.fault = faults[i % 5];
        peer.fault_block = 2;
        TEST_ASSERT_EQUAL_INT(ERR_OK, send(lengths[i / 5]));
        TEST_ASSERT_TRUE(peer.ended);
        TEST_ASSERT_EQUAL_size_t((peer.length + 127) / 128 * 128, peer.heard_length);
        TEST_ASSERT_EQUAL_INT(0, memcmp(peer.data, peer.heard, peer.length));
        for (size_t k = peer.length; k < peer.heard_length; k++) {
            TEST_ASSERT_EQUAL_UINT8(SUB, peer.heard[k]);
        }
    }
}

static void test_a_receiver_that_gives_up(void) {
    static const struct {
        fault_t fault;
        const char *message;
    } rows[] = {
        {DAMAGED_ALWAYS, "Transfer failed: no answer"},
        {CANCELS, "Transfer failed: cancelled"},
        {DIES, "Transfer failed: no answer"},
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
    peer.fault = CANCELS;
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
