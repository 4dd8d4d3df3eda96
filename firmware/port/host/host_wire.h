// The firmware's side of the serial wires, bit by bit at the pads. For host_clock.c and
// host_pads.c. Context: any.
#ifndef HOST_WIRE_H
#define HOST_WIRE_H

#include <stdbool.h>
#include <stdint.h>

// Time of the next bit that is sent or taken, HOST_CLOCK_NEVER: none; and doing what is due at
// `now_ns`. True: the exchange is over, something for the main loop to see.
uint64_t host_wire_next_ns(void);
bool host_wire_run(uint64_t now_ns);

// Pins have changed.
void host_wire_edges(uint64_t now_ns, uint32_t changed, uint32_t levels);

#endif
