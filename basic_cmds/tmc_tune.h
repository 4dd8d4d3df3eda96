// Handlers that change a driver which has been set up: current, StallGuard, CoolStep, StealthChop.
// Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_TUNE_H
#define BASIC_CMDS_TMC_TUNE_H

#include "basic/basic.h"

err_t tmc_tune_current(const basic_arg_t *args, size_t count);
err_t tmc_tune_sgthrs(const basic_arg_t *args, size_t count);
err_t tmc_tune_tcoolthrs(const basic_arg_t *args, size_t count);
err_t tmc_tune_stall(const basic_arg_t *args, size_t count);
err_t tmc_tune_coolstep(const basic_arg_t *args, size_t count);
err_t tmc_tune_stealth(const basic_arg_t *args, size_t count);

#endif
