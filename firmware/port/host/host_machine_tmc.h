// The lines of a machine file that describe driver chips.
#ifndef HOST_MACHINE_TMC_H
#define HOST_MACHINE_TMC_H

#include "simulate.h"

// Attaches the driver that the rest of a line describes; `find_axis` does not return if there is
// none of this name. Context: main, before time moves.
void host_machine_tmc(uint16_t chip, simulate_axis_t *(*find_axis)(const char *name), char *rest);

#endif
