// A simulated machine, read from a file: axes that the step and direction pins move, and the
// switches they press.
#ifndef HOST_MACHINE_H
#define HOST_MACHINE_H

#include "simulate.h"

// Reads the file and attaches what it describes (docs/user-guide.md has the format). Leaves the
// program with file, line and reason if a line is wrong. Context: main, before time moves.
void host_machine_load(const char *path);

// The axes, in the order of the file, with their names; NULL behind the last.
const simulate_axis_t *host_machine_axis(unsigned index, const char **name);

#endif
