// Datagrams byte by byte. Context: any.
#include "tmc22xx/datagram.h"

uint8_t datagram_crc(const uint8_t *bytes, size_t size) {
    uint8_t crc = 0;
    for (size_t i = 0; i < size; i++) {
        uint8_t byte = bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            bool carry = (((crc >> 7) ^ byte) & 1) != 0;
            crc = (uint8_t)((crc << 1) ^ (carry ? 0x07 : 0x00));
            byte >>= 1;
        }
    }
    return crc;
}

static void put_value(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
    }
}

static uint32_t take_value(const uint8_t *bytes) {
    uint32_t value = 0;
    for (int i = 0; i < 4; i++) {
        value = value << 8 | bytes[i];
    }
    return value;
}

void datagram_write(uint8_t frame[DATAGRAM_WRITE_SIZE], uint8_t address, uint8_t reg,
                    uint32_t value) {
    frame[0] = DATAGRAM_SYNC;
    frame[1] = address;
    frame[2] = (uint8_t)(reg | DATAGRAM_WRITE_BIT);
    put_value(&frame[3], value);
    frame[7] = datagram_crc(frame, 7);
}

void datagram_request(uint8_t frame[DATAGRAM_REQUEST_SIZE], uint8_t address, uint8_t reg) {
    frame[0] = DATAGRAM_SYNC;
    frame[1] = address;
    frame[2] = (uint8_t)(reg & ~DATAGRAM_WRITE_BIT);
    frame[3] = datagram_crc(frame, 3);
}

bool datagram_reply(const uint8_t frame[DATAGRAM_REPLY_SIZE], uint8_t reg, uint32_t *value) {
    if (frame[0] != DATAGRAM_SYNC || frame[1] != DATAGRAM_MASTER || frame[2] != reg ||
        frame[7] != datagram_crc(frame, 7)) {
        return false;
    }
    *value = take_value(&frame[3]);
    return true;
}
