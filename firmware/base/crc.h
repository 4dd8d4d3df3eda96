// Checksums of what is stored. Context: main loop.
#ifndef BASE_CRC_H
#define BASE_CRC_H

#include <stddef.h>
#include <stdint.h>

// CRC-32 as of IEEE 802.3 of these bytes behind those that gave `crc`; 0 to begin with.
uint32_t crc_add(uint32_t crc, const void *bytes, size_t size);

#endif
