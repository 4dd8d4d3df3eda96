// XMODEM. The sender waits for an answer to each block, so there is never more than a block on its
// way. Context: main loop.
#include "xmodem.h"

#include <stdbool.h>
#include <string.h>

#include "console.h"
#include "hal/hal.h"

#define SOH 0x01 // a block of 128 bytes follows
#define STX 0x02 // one of 1024
#define EOT 0x04 // that was all
#define ACK 0x06
#define NAK 0x15 // once more; at the start: with a checksum
#define CAN 0x18 // twice: cancelled
#define SUB 0x1A // fills the last block
#define CTRL_C 0x03
#define ASK_CRC 'C' // at the start: with a CRC

#define SMALL_BLOCK 128u
#define LARGE_BLOCK 1024u
#define FRAME 3u // kind, number, its complement

#define TRIES_MAX 10 // for one block
#define ASK_TRIES 10 // with ASK_CRC, before a checksum is asked for
#define ASK_US 3000000u
#define BLOCK_US 10000000u  // until the next block or an answer comes
#define START_US 60000000u  // until a receiver asks
#define BYTE_US 1000000u    // between two bytes of a block; also what counts as silence
#define SILENCE_US 5000000u // how long silence is waited for at most

static struct {
    uint8_t *buffer;
    xmodem_sink_t sink;
    bool crc;
    uint8_t expected;  // number of the next block
    bool begun;        // a block was taken
    size_t padding;    // bytes at the end of the last block that are padding if nothing follows
    unsigned failures; // one after the other
} transfer;

// ---- The line -----------------------------------------------------------------------------------

// The next byte, or -1 if none comes in time.
static int take(uint64_t timeout_us) {
    uint64_t until_us = hal_time_us() + timeout_us;
    int byte;
    while ((byte = console_take()) < 0 && hal_time_us() < until_us && !hal_end_of_input()) {
        console_wait(until_us);
    }
    return byte;
}

static void send_bytes(const void *bytes, size_t size) {
    console_write(bytes, size);
    console_flush();
}

static void send_byte(uint8_t byte) {
    send_bytes(&byte, 1);
}

// True if the last bytes before it say that the transfer is cancelled.
static bool wait_for_silence(void) {
    uint64_t until_us = hal_time_us() + SILENCE_US;
    int before = -1;
    int last = -1;
    int byte;
    while ((byte = take(BYTE_US)) >= 0 && hal_time_us() < until_us) {
        before = last;
        last = byte;
    }
    return before == CAN && last == CAN;
}

// Tells the other side, and lets pass what it still sends: the prompt would take it for commands.
static void cancel(void) {
    static const uint8_t cancellation[] = {CAN, CAN, CAN, CAN, '\b', '\b', '\b', '\b'};
    send_bytes(cancellation, sizeof cancellation);
    wait_for_silence();
}

static err_t fail(const char *reason) {
    cancel();
    return err_raise(ERR_TRANSFER, "%s", reason);
}

// The same for an error that was raised already; while waiting others may be.
static err_t fail_raised(void) {
    char message[ERR_MESSAGE_SIZE];
    strcpy(message, err_message());
    cancel();
    return err_raise(ERR_ARGUMENT, "%s", message);
}

// A byte that opens a block or answers one. Two CAN in a row, or a Ctrl-C, are a cancellation: CAN.
// A single CAN is noise: -1.
static int take_control(uint64_t timeout_us) {
    int byte = take(timeout_us);
    if (byte == CAN) {
        return take(BYTE_US) == CAN ? CAN : -1;
    }
    return byte == CTRL_C ? CAN : byte;
}

static uint16_t crc16(const uint8_t *bytes, size_t size) {
    unsigned crc = 0;
    for (size_t i = 0; i < size; i++) {
        crc ^= (unsigned)bytes[i] << 8;
        for (int bit = 0; bit < 8; bit++) {
            crc = crc & 0x8000u ? crc << 1 ^ 0x1021u : crc << 1;
        }
    }
    return (uint16_t)crc;
}

static uint8_t checksum(const uint8_t *bytes, size_t size) {
    unsigned sum = 0;
    for (size_t i = 0; i < size; i++) {
        sum += bytes[i];
    }
    return (uint8_t)sum;
}

// ---- Receiving ----------------------------------------------------------------------------------

// Asks until something comes; the first byte, or -1.
static int take_first(void) {
    for (int i = 0; i < ASK_TRIES + TRIES_MAX; i++) {
        transfer.crc = i < ASK_TRIES;
        send_byte(transfer.crc ? ASK_CRC : NAK);
        int byte = take_control(transfer.crc ? ASK_US : BLOCK_US);
        if (byte >= 0) {
            return byte;
        }
    }
    return -1;
}

// The rest of a block into the buffer. False: it is damaged.
static bool take_block(size_t size) {
    size_t total = FRAME - 1 + size + (transfer.crc ? 2 : 1);
    for (size_t i = 0; i < total; i++) {
        int byte = take(BYTE_US);
        if (byte < 0) {
            return false;
        }
        transfer.buffer[i] = (uint8_t)byte;
    }
    const uint8_t *data = transfer.buffer + FRAME - 1;
    const uint8_t *check = data + size;
    if ((transfer.buffer[0] ^ transfer.buffer[1]) != 0xFF) {
        return false;
    }
    return transfer.crc ? crc16(data, size) == (check[0] << 8 | check[1])
                        : checksum(data, size) == check[0];
}

// What may be padding is passed on only once a further block shows that it is not.
static err_t pass_on(size_t size) {
    static const uint8_t padding[16] = {SUB, SUB, SUB, SUB, SUB, SUB, SUB, SUB,
                                        SUB, SUB, SUB, SUB, SUB, SUB, SUB, SUB};
    err_t error = ERR_OK;
    while (transfer.padding > 0 && error == ERR_OK) {
        size_t part = transfer.padding < sizeof padding ? transfer.padding : sizeof padding;
        error = transfer.sink(padding, part);
        transfer.padding -= part;
    }
    const uint8_t *data = transfer.buffer + FRAME - 1;
    while (size > transfer.padding && data[size - 1 - transfer.padding] == SUB) {
        transfer.padding++;
    }
    return error != ERR_OK ? error : transfer.sink(data, size - transfer.padding);
}

// A damaged or missing block is asked for again. ERR_OK: go on.
static err_t ask_again(void) {
    if (++transfer.failures >= TRIES_MAX) {
        return fail(transfer.begun ? "too many errors" : "no answer");
    }
    if (wait_for_silence()) {
        return fail("cancelled");
    }
    send_byte(NAK);
    return ERR_OK;
}

static err_t receive_block(size_t size) {
    if (!take_block(size)) {
        return ask_again();
    }
    uint8_t number = transfer.buffer[0];
    bool repeated = transfer.begun && number == (uint8_t)(transfer.expected - 1);
    if (!repeated && number != transfer.expected) {
        return fail("a block is missing");
    }
    if (!repeated) { // otherwise our answer got lost
        err_t error = pass_on(size);
        if (error != ERR_OK) {
            return fail_raised();
        }
        transfer.expected++;
        transfer.begun = true;
    }
    transfer.failures = 0;
    send_byte(ACK);
    return ERR_OK;
}

static err_t receive(void) {
    int byte = take_first();
    if (byte < 0) {
        return fail("no answer");
    }
    for (;;) {
        err_t error = ERR_OK;
        if (byte == SOH || byte == STX) {
            error = receive_block(byte == SOH ? SMALL_BLOCK : LARGE_BLOCK);
        } else if (byte == EOT) {
            send_byte(ACK);
            return ERR_OK;
        } else if (byte == CAN) {
            return fail("cancelled");
        } else {
            error = ask_again();
        }
        if (error != ERR_OK) {
            return error;
        }
        byte = take_control(BLOCK_US);
    }
}

err_t xmodem_receive(xmodem_sink_t sink, uint8_t *buffer) {
    memset(&transfer, 0, sizeof transfer);
    transfer.buffer = buffer;
    transfer.sink = sink;
    transfer.expected = 1;
    console_flush();
    console_set_raw(true);
    err_t error = receive();
    console_set_raw(false);
    return error;
}

// ---- Sending ------------------------------------------------------------------------------------

// Waits for a receiver. ERR_OK: transfer.crc is what it wants.
static err_t wait_for_receiver(void) {
    uint64_t until_us = hal_time_us() + START_US;
    while (hal_time_us() < until_us && !hal_end_of_input()) {
        int byte = take_control(ASK_US);
        if (byte == ASK_CRC || byte == NAK) {
            transfer.crc = byte == ASK_CRC;
            return ERR_OK;
        }
        if (byte == CAN) {
            return fail("cancelled");
        }
    }
    return fail("no answer");
}

// Sends the first `size` bytes of the buffer until they are acknowledged.
static err_t send_until_acknowledged(size_t size) {
    for (int i = 0; i < TRIES_MAX; i++) {
        while (console_take() >= 0) { // answers that came too late would be taken for this block's
        }
        send_bytes(transfer.buffer, size);
        int byte;
        do {
            byte = take_control(BLOCK_US);
        } while (byte >= 0 && byte != ACK && byte != NAK && byte != CAN && byte != ASK_CRC);
        if (byte == ACK) {
            return ERR_OK;
        }
        if (byte == CAN) {
            return fail("cancelled");
        }
    }
    return fail("no answer");
}

static err_t send_block(uint8_t number, size_t used) {
    uint8_t *data = transfer.buffer + FRAME;
    memset(data + used, SUB, SMALL_BLOCK - used);
    transfer.buffer[0] = SOH;
    transfer.buffer[1] = number;
    transfer.buffer[2] = (uint8_t)~number;
    if (!transfer.crc) {
        data[SMALL_BLOCK] = checksum(data, SMALL_BLOCK);
        return send_until_acknowledged(FRAME + SMALL_BLOCK + 1);
    }
    uint16_t crc = crc16(data, SMALL_BLOCK);
    data[SMALL_BLOCK] = (uint8_t)(crc >> 8);
    data[SMALL_BLOCK + 1] = (uint8_t)crc;
    return send_until_acknowledged(FRAME + SMALL_BLOCK + 2);
}

static err_t send(xmodem_source_t source) {
    err_t error = wait_for_receiver();
    size_t got = SMALL_BLOCK;
    for (uint8_t number = 1; error == ERR_OK && got == SMALL_BLOCK; number++) {
        error = source(transfer.buffer + FRAME, SMALL_BLOCK, &got);
        if (error != ERR_OK) {
            return fail_raised();
        }
        if (got > 0) {
            error = send_block(number, got);
        }
    }
    if (error == ERR_OK) {
        transfer.buffer[0] = EOT;
        error = send_until_acknowledged(1);
    }
    return error;
}

err_t xmodem_send(xmodem_source_t source, uint8_t *buffer) {
    memset(&transfer, 0, sizeof transfer);
    transfer.buffer = buffer;
    console_flush();
    console_set_raw(true);
    err_t error = send(source);
    console_set_raw(false);
    return error;
}
