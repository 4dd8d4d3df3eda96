// Datagrams: the captured frames of the PicoMite firmware byte for byte, the CRC against a division
// of polynomials, and replies that are damaged in every way: none is taken for a good one.
#include "tmc22xx/datagram.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "base/base.h"

#define RANDOM_FRAMES 2000000

void setUp(void) {}
void tearDown(void) {}

static uint64_t random_state = 0x2545F4914F6CDD1Du;

static uint32_t random_word(void) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (uint32_t)(random_state >> 32);
}

// ---- CRC ----------------------------------------------------------------------------------------

// What the datasheet defines: the bits in the order they are on the wire, as one long polynomial,
// times x^8; what is left of it behind the division by x^8 + x^2 + x + 1.
static uint8_t crc_by_division(const uint8_t *bytes, size_t size) {
    uint8_t bits[8 * 16] = {0};
    for (size_t i = 0; i < 8 * size; i++) {
        bits[i] = (bytes[i / 8] >> (i % 8)) & 1;
    }
    static const uint8_t divisor[9] = {1, 0, 0, 0, 0, 0, 1, 1, 1};
    for (size_t i = 0; i < 8 * size; i++) {
        for (size_t j = 0; bits[i] != 0 && j < sizeof(divisor); j++) {
            bits[i + sizeof(divisor) - 1 - j] ^= divisor[sizeof(divisor) - 1 - j];
        }
    }
    uint8_t rest = 0;
    for (size_t i = 8 * size; i < 8 * size + 8; i++) {
        rest = (uint8_t)(rest << 1 | bits[i]);
    }
    return rest;
}

static void test_crc_is_the_rest_of_a_division(void) {
    for (int round = 0; round < 20000; round++) {
        uint8_t bytes[8];
        size_t size = random_word() % (sizeof(bytes) + 1);
        for (size_t i = 0; i < size; i++) {
            bytes[i] = (uint8_t)random_word();
        }
        TEST_ASSERT_EQUAL_HEX8(crc_by_division(bytes, size), datagram_crc(bytes, size));
    }
}

// ---- Frames -------------------------------------------------------------------------------------

// Captured from the original: address, register, value, frame.
static const struct {
    uint8_t address;
    uint8_t reg;
    uint32_t value;
    uint8_t frame[8];
} golden[] = {
    {0, 0x00, 0x000001C0, {0x05, 0x00, 0x80, 0x00, 0x00, 0x01, 0xC0, 0xF6}},
    {0, 0x10, 0x00081907, {0x05, 0x00, 0x90, 0x00, 0x08, 0x19, 0x07, 0x15}},
    {0, 0x11, 0x00000014, {0x05, 0x00, 0x91, 0x00, 0x00, 0x00, 0x14, 0x1F}},
    {0, 0x6C, 0x14030153, {0x05, 0x00, 0xEC, 0x14, 0x03, 0x01, 0x53, 0x69}},
    {0, 0x70, 0xCF0D0E24, {0x05, 0x00, 0xF0, 0xCF, 0x0D, 0x0E, 0x24, 0x96}},
    {0, 0x00, 0x000001C4, {0x05, 0x00, 0x80, 0x00, 0x00, 0x01, 0xC4, 0x16}},
    {0, 0x10, 0x0008190C, {0x05, 0x00, 0x90, 0x00, 0x08, 0x19, 0x0C, 0x2B}},
    {0, 0x6C, 0x13030153, {0x05, 0x00, 0xEC, 0x13, 0x03, 0x01, 0x53, 0x0D}},
    {1, 0x00, 0x000001C0, {0x05, 0x01, 0x80, 0x00, 0x00, 0x01, 0xC0, 0x1A}},
    {1, 0x10, 0x00081104, {0x05, 0x01, 0x90, 0x00, 0x08, 0x11, 0x04, 0xE0}},
    {1, 0x11, 0x00000014, {0x05, 0x01, 0x91, 0x00, 0x00, 0x00, 0x14, 0xF3}},
    {1, 0x6C, 0x14010153, {0x05, 0x01, 0xEC, 0x14, 0x01, 0x01, 0x53, 0x03}},
    {1, 0x70, 0xCF0D0E24, {0x05, 0x01, 0xF0, 0xCF, 0x0D, 0x0E, 0x24, 0x7A}},
    {0, 0x10, 0x00081F1F, {0x05, 0x00, 0x90, 0x00, 0x08, 0x1F, 0x1F, 0xA8}},
    {0, 0x6C, 0x10010153, {0x05, 0x00, 0xEC, 0x10, 0x01, 0x01, 0x53, 0x21}},
    {0, 0x14, 200, {0x05, 0x00, 0x94, 0x00, 0x00, 0x00, 0xC8, 0x4D}},
    {0, 0x40, 120, {0x05, 0x00, 0xC0, 0x00, 0x00, 0x00, 0x78, 0xD7}},
    {0, 0x14, 0, {0x05, 0x00, 0x94, 0x00, 0x00, 0x00, 0x00, 0x34}},
};

static void test_writes_are_the_captured_frames(void) {
    for (size_t i = 0; i < COUNT_OF_ARRAY(golden); i++) {
        uint8_t frame[DATAGRAM_WRITE_SIZE];
        datagram_write(frame, golden[i].address, golden[i].reg, golden[i].value);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(golden[i].frame, frame, sizeof(frame));
    }
}

static void test_a_request_is_its_parts_and_their_crc(void) {
    for (unsigned address = 0; address < 4; address++) {
        for (unsigned reg = 0; reg < 0x80; reg++) {
            uint8_t frame[DATAGRAM_REQUEST_SIZE];
            datagram_request(frame, (uint8_t)address, (uint8_t)reg);
            uint8_t parts[] = {0x05, (uint8_t)address, (uint8_t)reg};
            TEST_ASSERT_EQUAL_HEX8_ARRAY(parts, frame, sizeof(parts));
            TEST_ASSERT_EQUAL_HEX8(crc_by_division(parts, sizeof(parts)), frame[3]);
        }
    }
}

// ---- Replies ------------------------------------------------------------------------------------

static void make_reply(uint8_t frame[8], uint8_t reg, uint32_t value) {
    uint8_t parts[8] = {0x05,
                        0xFF,
                        reg,
                        (uint8_t)(value >> 24),
                        (uint8_t)(value >> 16),
                        (uint8_t)(value >> 8),
                        (uint8_t)value};
    parts[7] = crc_by_division(parts, 7);
    memcpy(frame, parts, sizeof(parts));
}

// Looks at a copy of exactly the reply's size, so that a sanitizer sees who reads beyond it.
static bool taken(const uint8_t frame[8], uint8_t reg, uint32_t *value) {
    uint8_t *copy = malloc(DATAGRAM_REPLY_SIZE);
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, frame, DATAGRAM_REPLY_SIZE);
    bool good = datagram_reply(copy, reg, value);
    free(copy);
    return good;
}

static void assert_refused(const uint8_t frame[8], uint8_t reg) {
    uint32_t value = 0xA5A5A5A5u;
    TEST_ASSERT_FALSE(taken(frame, reg, &value));
    TEST_ASSERT_EQUAL_HEX32(0xA5A5A5A5u, value);
}

static void test_a_good_reply_is_taken(void) {
    for (unsigned reg = 0; reg < 0x80; reg++) {
        uint8_t frame[8];
        uint32_t sent = random_word();
        uint32_t value = ~sent;
        make_reply(frame, (uint8_t)reg, sent);
        TEST_ASSERT_TRUE(taken(frame, (uint8_t)reg, &value));
        TEST_ASSERT_EQUAL_HEX32(sent, value);
    }
}

static void flip(uint8_t frame[8], unsigned bit) {
    frame[bit / 8] ^= (uint8_t)(1u << (bit % 8));
}

// The polynomial finds all errors of one, two and three bits in so short a frame.
static void test_up_to_three_flipped_bits_are_refused(void) {
    static const uint32_t values[] = {0x00000000, 0xFFFFFFFF, 0x21000041, 0x05FF0205};
    for (size_t i = 0; i < COUNT_OF_ARRAY(values); i++) {
        uint8_t frame[8];
        make_reply(frame, 0x06, values[i]);
        for (unsigned a = 0; a < 64; a++) {
            flip(frame, a);
            assert_refused(frame, 0x06);
            for (unsigned b = 0; b < a; b++) {
                flip(frame, b);
                assert_refused(frame, 0x06);
                for (unsigned c = 0; c < b; c++) {
                    flip(frame, c);
                    assert_refused(frame, 0x06);
                    flip(frame, c);
                }
                flip(frame, b);
            }
            flip(frame, a);
        }
    }
}

// Another register's, a request's or a write's echo, another sync or address with a right CRC.
static void test_whole_frames_that_are_no_answer_are_refused(void) {
    uint8_t frame[8];
    for (unsigned other = 0; other < 0x100; other++) {
        make_reply(frame, (uint8_t)other, 0x12345678);
        if (other != 0x6F) {
            assert_refused(frame, 0x6F);
        }
    }
    for (unsigned byte = 0; byte < 0x100; byte++) {
        for (unsigned at = 0; at < 2; at++) {
            make_reply(frame, 0x6F, 0x12345678);
            if (frame[at] != byte) {
                frame[at] = (uint8_t)byte;
                frame[7] = crc_by_division(frame, 7);
                assert_refused(frame, 0x6F);
            }
        }
    }
    datagram_write(frame, 0, 0x6F, 0x12345678);
    assert_refused(frame, 0x6F);
    memset(frame, 0x00, sizeof(frame));
    assert_refused(frame, 0x00);
    memset(frame, 0xFF, sizeof(frame));
    assert_refused(frame, 0x7F);
}

// The wire carries the request's echo, the reply and then nothing; read from any other bit on,
// eight bytes of it are no reply.
static void test_a_stream_read_from_the_wrong_bit_is_refused(void) {
    for (int round = 0; round < 2000; round++) {
        uint8_t stream[DATAGRAM_REQUEST_SIZE + 2 * DATAGRAM_REPLY_SIZE];
        memset(stream, 0xFF, sizeof(stream));
        uint8_t reg = (uint8_t)(random_word() & 0x7F);
        datagram_request(stream, (uint8_t)(random_word() & 3), reg);
        make_reply(&stream[DATAGRAM_REQUEST_SIZE], reg, random_word());
        for (unsigned start = 0; start <= 8 * (sizeof(stream) - 8); start++) {
            uint8_t frame[8] = {0};
            for (unsigned bit = 0; bit < 64; bit++) {
                unsigned at = start + bit;
                frame[bit / 8] |= (uint8_t)(((stream[at / 8] >> (at % 8)) & 1) << (bit % 8));
            }
            uint32_t value;
            TEST_ASSERT_EQUAL(start == 8 * DATAGRAM_REQUEST_SIZE, taken(frame, reg, &value));
        }
    }
}

static bool is_answer(const uint8_t frame[8], uint8_t reg) {
    return frame[0] == 0x05 && frame[1] == 0xFF && frame[2] == reg &&
           frame[7] == crc_by_division(frame, 7);
}

// A good reply, of which some bytes are replaced, exchanged, repeated or left out.
static void damage(uint8_t frame[8]) {
    for (uint32_t times = random_word() % 4; times > 0; times--) {
        unsigned at = random_word() % 8;
        switch (random_word() % 4) {
        case 0:
            frame[at] = (uint8_t)random_word();
            break;
        case 1:
            frame[at] = frame[random_word() % 8];
            break;
        case 2:
            memmove(&frame[at], &frame[at + 1], 7 - at);
            break;
        default:
            memmove(&frame[at + 1], &frame[at], 7 - at);
            break;
        }
    }
}

static void test_damaged_replies_are_taken_only_if_they_are_whole(void) {
    unsigned whole = 0;
    for (int round = 0; round < RANDOM_FRAMES / 10; round++) {
        uint8_t frame[8];
        uint8_t reg = (uint8_t)(random_word() & 0x7F);
        make_reply(frame, reg, random_word());
        damage(frame);
        uint32_t value;
        bool answer = is_answer(frame, reg);
        whole += answer;
        TEST_ASSERT_EQUAL(answer, taken(frame, reg, &value));
    }
    TEST_ASSERT_GREATER_THAN_UINT(RANDOM_FRAMES / 50, whole);
    TEST_ASSERT_LESS_THAN_UINT(RANDOM_FRAMES / 20, whole);
}

static void test_garbage_is_refused(void) {
    for (int round = 0; round < RANDOM_FRAMES; round++) {
        uint32_t words[2] = {random_word(), random_word()};
        uint8_t frame[8];
        memcpy(frame, words, sizeof(frame));
        uint32_t value;
        TEST_ASSERT_FALSE(datagram_reply(frame, frame[2] & 0x7F, &value));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_crc_is_the_rest_of_a_division);
    RUN_TEST(test_writes_are_the_captured_frames);
    RUN_TEST(test_a_request_is_its_parts_and_their_crc);
    RUN_TEST(test_a_good_reply_is_taken);
    RUN_TEST(test_up_to_three_flipped_bits_are_refused);
    RUN_TEST(test_whole_frames_that_are_no_answer_are_refused);
    RUN_TEST(test_a_stream_read_from_the_wrong_bit_is_refused);
    RUN_TEST(test_damaged_replies_are_taken_only_if_they_are_whole);
    RUN_TEST(test_garbage_is_refused);
    return UNITY_END();
}
