// A peer that knows XMODEM from its definition and shares no code with the firmware's.
#include "peer.h"

#include <string.h>

#include <unity.h>

#include "board.h"

#define SOH 0x01
#define STX 0x02
#define EOT 0x04
#define ACK 0x06
#define NAK 0x15
#define CAN 0x18

peer_t peer;

void peer_start(void) {
    memset(&peer, 0, sizeof peer);
    peer.block_size = 128;
    for (size_t i = 0; i < PEER_DATA_MAX; i++) {
        peer.data[i] = (uint8_t)(i * 7 + i / 251);
    }
}

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

// ---- The peer as sender -------------------------------------------------------------------------

static bool fault_now(peer_fault_t fault) {
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
    frame[1] = (uint8_t)(peer.block + 1 + (fault_now(PEER_NUMBER_DAMAGED) ? 4 : 0));
    frame[2] = (uint8_t)~(peer.block + 1);
    memset(frame + 3, PEER_PADDING, peer.block_size);
    memcpy(frame + 3, peer.data + start, used);
    size_t size = 3 + peer.block_size;
    if (peer.fault == PEER_CHECKSUM_ONLY) {
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
    bool again = peer.fault == PEER_DAMAGED_ALWAYS && peer.block == peer.fault_block;
    if (fault_now(PEER_DAMAGED) || again) {
        frame[50] ^= 0x10;
    }
    if (fault_now(PEER_BYTE_LOST)) {
        memmove(frame + 20, frame + 21, size - 21);
        size--;
    }
    if (fault_now(PEER_BYTE_ADDED)) {
        memmove(frame + 21, frame + 20, size - 20);
        size++;
    }
    if (!fault_now(PEER_BLOCK_LOST)) {
        board_type((const char *)frame, size);
    }
}

static void start_sending(uint8_t byte) {
    if (byte == 'C' && peer.fault == PEER_CHECKSUM_ONLY) {
        return;
    }
    if (peer.fault == PEER_LATE && board.time_us < 20000000) {
        return;
    }
    if (byte == 'C' || byte == NAK) {
        if (fault_now(PEER_NOISE_FIRST)) {
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
    if (byte == ACK && fault_now(PEER_ANSWER_LOST)) {
        put_block(); // once more, as after a time without an answer
        return;
    }
    peer.block += byte == ACK;
    if (byte != ACK && byte != NAK) {
        return;
    }
    if (fault_now(PEER_CANCELS)) {
        board_type("\x18\x18\x18", 3);
    } else if (fault_now(PEER_USER_BREAK)) {
        board_type("\x03", 1);
    } else if (peer.fault != PEER_DIES || peer.block < peer.fault_block) {
        if (fault_now(PEER_CANCELS_ONCE_ONLY)) {
            board_type("\x18", 1);
            return;
        }
        peer.block += fault_now(PEER_BLOCK_SKIPPED);
        put_block();
    }
}

void peer_hear_answers(const uint8_t *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        hear_answer(bytes[i]);
    }
}

// ---- The peer as receiver -----------------------------------------------------------------------

static void answer(uint8_t byte) {
    board_type((const char *)&byte, 1);
}

static void judge_block(void) {
    size_t end = 3 + 128;
    bool good = (peer.frame[1] ^ peer.frame[2]) == 0xFF;
    if (peer.fault == PEER_CHECKSUM_ONLY) {
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
    bool damaged = fault_now(PEER_DAMAGED) || fault_now(PEER_LATE_ANSWER) ||
                   (peer.fault == PEER_DAMAGED_ALWAYS && peer.block == peer.fault_block);
    if (damaged) {
        answer(NAK);
        return;
    }
    if (fault_now(PEER_CANCELS)) {
        board_type("\x18\x18", 2);
        return;
    }
    if (peer.fault == PEER_DIES && peer.block == peer.fault_block) {
        return;
    }
    if (!repeated) {
        memcpy(peer.heard + peer.heard_length, peer.frame + 3, 128);
        peer.heard_length += 128;
        peer.block++;
    }
    if (peer.fault == PEER_ANSWER_LOST && peer.block == peer.fault_block + 1 && !peer.done_fault) {
        peer.done_fault = true;
        return;
    }
    answer(ACK);
}

void peer_hear_blocks(const uint8_t *bytes, size_t size) {
    size_t frame_size = 3 + 128 + (peer.fault == PEER_CHECKSUM_ONLY ? 1 : 2);
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
