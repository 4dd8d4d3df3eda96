// The arrival of bytes at the simulated serial ports, which is news for the main loop. Context:
// main.
#ifndef HOST_SERIAL_H
#define HOST_SERIAL_H

#include <stdint.h>

// When the next byte arrives that nobody has noticed; HOST_CLOCK_NEVER if there is none.
uint64_t host_serial_next_ns(void);

// Those up to `now_ns` have been noticed.
void host_serial_notice(uint64_t now_ns);

#endif
