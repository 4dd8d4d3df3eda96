// StallGuard around homing. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_HOMING_H
#define BASIC_CMDS_TMC_HOMING_H

#include "base/base.h"

// From now on homing arms the drivers that are tied to the axes it homes.
void tmc_homing_start(void);

// Before wires are closed: waits until what homing has armed is disarmed, or the drivers would stay
// so. Errors: homing needs them just now; Ctrl-C.
err_t tmc_homing_await(void);

// The same behind the end of all motion, whoever presses keys.
void tmc_homing_finish(void);

// Something was told about a driver: homing that relies on it stops, rather than run into the end
// of an axis.
void tmc_homing_look(void);

#endif
