// What follows the edges of input pins. Context: any.
#ifndef HOST_COUNTERS_H
#define HOST_COUNTERS_H

#include <stdint.h>

// `changed`: the pins with an edge; `levels`: all pins after it. For host_pads.c.
void host_counters_edges(uint64_t time_ns, uint32_t changed, uint32_t levels);

#endif
