// The edge recorder: EDGES.csv, header `time_ns,gpio,level`, a row for each edge of each output
// pin, in order of time; edges of the same moment in order of GPIO if one call made them, else in
// order of the calls. Every row is a change of what the pad shows, seen from reset, when all pads
// are low. A pin that becomes an output leaves a row only if its first level differs from what the
// pad showed as an input; one that stops being an output leaves a row if the pad changes with it.
#ifndef HOST_TRACE_H
#define HOST_TRACE_H

#include <stdbool.h>
#include <stdint.h>

// Starts recording. Leaves the program with a message if the file cannot be written. Context: main.
void host_trace_open(const char *path);

// Records the pins in `changed` with their new `levels`. Costs next to nothing while not recording.
// Context: any.
void host_trace_edges(uint64_t time_ns, uint32_t changed, uint32_t levels);

bool host_trace_is_open(void);

// One row as it is; no effect while not recording. For host_pwm.c, whose edges are found when they
// are wanted.
void host_trace_row(uint64_t time_ns, unsigned gpio, bool level);

// Writes what is still buffered. No effect if not recording. Context: main.
void host_trace_close(void);

#endif
