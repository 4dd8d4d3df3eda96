// StallGuard around homing. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_HOMING_H
#define BASIC_CMDS_TMC_HOMING_H

// From now on homing arms the drivers that are tied to the axes it homes.
void tmc_homing_start(void);

#endif
