// Handler of TMC22xx STATUS. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_STATUS_H
#define BASIC_CMDS_TMC_STATUS_H

#include "basic/basic.h"

err_t tmc_status(const basic_arg_t *args, size_t count);

#endif
