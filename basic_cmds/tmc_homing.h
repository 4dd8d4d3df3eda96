// StallGuard around homing. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_HOMING_H
#define BASIC_CMDS_TMC_HOMING_H

#include "base/base.h"

// Without a threshold of the user's a stall is looked for from this part of the seek feed on: so
// the approach is above it with room to spare, and most of its ramp below.
#define TMC_HOMING_FEED_PART 0.6

// From now on homing arms the drivers that are tied to the axes it homes.
void tmc_homing_start(void);

// Before wires change or are closed: waits until what homing has armed is disarmed, or the drivers
// would stay so. Errors: homing needs them just now; Ctrl-C.
err_t tmc_homing_await(void);

// The same behind the end of all motion, whoever presses keys.
void tmc_homing_finish(void);

// Something was told about a driver: homing that relies on it stops, rather than run into the end
// of an axis.
void tmc_homing_look(void);

#endif
