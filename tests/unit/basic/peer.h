// The other end of an XMODEM transfer, with named faults, in virtual time.
#ifndef PEER_H
#define PEER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PEER_DATA_MAX 40000 // more than 255 blocks of 128 bytes
#define PEER_PADDING 0x1A   // fills the last block

typedef enum {
    PEER_NO_FAULT,
    PEER_LATE,              // starts after 20 s
    PEER_CHECKSUM_ONLY,     // knows no CRC
    PEER_NOISE_FIRST,       // garbage before the first block
    PEER_DAMAGED,           // one byte of a block is wrong, once
    PEER_DAMAGED_ALWAYS,    // and again each time
    PEER_BYTE_LOST,         // a block lacks a byte, once
    PEER_BYTE_ADDED,        // a block has one too many, once
    PEER_BLOCK_LOST,        // does not come, once
    PEER_NUMBER_DAMAGED,    // the block's number is wrong, once
    PEER_ANSWER_LOST,       // the peer does not hear an ACK, or we do not hear its
    PEER_BLOCK_SKIPPED,     // goes on with the next but one
    PEER_CANCELS,           // in the middle
    PEER_CANCELS_ONCE_ONLY, // a single CAN: noise
    PEER_USER_BREAK,        // somebody types Ctrl-C in the middle
    PEER_DIES,              // says nothing more
    PEER_LATE_ANSWER,       // asks several times before we listen
} peer_fault_t;

typedef struct {
    peer_fault_t fault;
    unsigned fault_block; // from 0
    bool done_fault;
    uint8_t data[PEER_DATA_MAX];
    size_t length;
    size_t block_size;
    unsigned block;
    bool started, ended;
    uint8_t heard[PEER_DATA_MAX]; // by the peer as receiver
    size_t heard_length;
    uint8_t frame[1100];
    size_t frame_length;
    unsigned cancels;
} peer_t;

extern peer_t peer;

// Without a fault, with new data, in blocks of 128 bytes.
void peer_start(void);

// For board.on_write: what the peer does as sender, and as receiver, with the bytes we send.
void peer_hear_answers(const uint8_t *bytes, size_t size);
void peer_hear_blocks(const uint8_t *bytes, size_t size);

#endif
