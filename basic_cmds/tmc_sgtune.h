// TMC22xx SGTUNE. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_SGTUNE_H
#define BASIC_CMDS_TMC_SGTUNE_H

#include "basic/basic.h"

// Where each argument stands in the row's spec.
enum { SGTUNE_DRIVER, SGTUNE_FEED, SGTUNE_DISTANCE, SGTUNE_TX_PIN, SGTUNE_ARGS };

// Jogs the axis of a driver, prints what StallGuard reads meanwhile and proposes its thresholds.
err_t tmc_sgtune(const basic_arg_t *args, size_t count);

#endif
