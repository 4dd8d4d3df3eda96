// XMODEM over the console: receives blocks of 128 and 1024 bytes, sends 128; CRC or checksum,
// whatever the other side wants. While it works every byte belongs to it, and nothing else is
// printed. Context: main loop.
#ifndef BASIC_XMODEM_H
#define BASIC_XMODEM_H

#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

#define XMODEM_BUFFER_SIZE 1032u // for a block with its frame

// Takes the next bytes of what is received. With an error the transfer is cancelled.
typedef err_t (*xmodem_sink_t)(const void *bytes, size_t size);

// Gives up to `size` next bytes to send; *got below `size`: these are the last.
typedef err_t (*xmodem_source_t)(void *bytes, size_t size, size_t *got);

// Both return when the transfer is over; `buffer` has XMODEM_BUFFER_SIZE bytes. The padding of the
// last block (Ctrl-Z) is not passed on. Errors: cancelled (Ctrl-X twice, or Ctrl-C while nothing is
// on its way), no answer, too many errors, and those of sink and source.
err_t xmodem_receive(xmodem_sink_t sink, uint8_t *buffer);
err_t xmodem_send(xmodem_source_t source, uint8_t *buffer);

#endif
