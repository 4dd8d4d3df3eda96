// Edges that the outside world applies to input pins, from a file, at their virtual times.
#ifndef HOST_INPUTS_H
#define HOST_INPUTS_H

#include <stdint.h>

// Reads EVENTS.csv: a header `time_ns,gpio,level` (may be missing), then one edge a line, in any
// order; edges of the same time are applied in the order of the file. Blank lines are skipped.
// Instead of a level a line may have the voltage of the pin, as `5000,26,1.65V`, and with TEMP
// instead of a pin the temperature of the chip, as `5000,TEMP,25.5C`. Leaves the program with file,
// line and reason if a line is wrong. Context: main, before time moves.
void host_inputs_load(const char *path);

// Time of the next edge; HOST_CLOCK_NEVER if none is left. Context: any.
uint64_t host_inputs_next_ns(void);

// Applies all edges up to and including `now_ns`. Context: main.
void host_inputs_apply(uint64_t now_ns);

#endif
