// The datagrams of the TMC2208 and TMC2209: made from an access, checked completely when they come
// back (datasheet TMC2209 rev. 1.09, section 4.1). Context: any.
#ifndef TMC22XX_DATAGRAM_H
#define TMC22XX_DATAGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DATAGRAM_WRITE_SIZE 8u
#define DATAGRAM_REQUEST_SIZE 4u
#define DATAGRAM_REPLY_SIZE 8u

#define DATAGRAM_SYNC 0x05u      // first byte of all of them
#define DATAGRAM_MASTER 0xFFu    // address in a reply: it is for who asked
#define DATAGRAM_WRITE_BIT 0x80u // in the register's address

// CRC of a datagram: polynomial x^8 + x^2 + x + 1, beginning with 0, lowest bit of each byte first.
uint8_t datagram_crc(const uint8_t *bytes, size_t size);

// Write `value` to a register of the driver at `address` (0..3).
void datagram_write(uint8_t frame[DATAGRAM_WRITE_SIZE], uint8_t address, uint8_t reg,
                    uint32_t value);

// Ask the driver at `address` for a register.
void datagram_request(uint8_t frame[DATAGRAM_REQUEST_SIZE], uint8_t address, uint8_t reg);

// True if these bytes are the answer to the request for `reg`, whole and undamaged: only then
// *value is set. A reply does not tell which driver it is from.
bool datagram_reply(const uint8_t frame[DATAGRAM_REPLY_SIZE], uint8_t reg, uint32_t *value);

#endif
