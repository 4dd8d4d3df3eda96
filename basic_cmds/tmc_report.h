// Handlers of what shows and takes a driver's registers. Inside basic_cmds/ only. Context: main
// loop.
#ifndef BASIC_CMDS_TMC_REPORT_H
#define BASIC_CMDS_TMC_REPORT_H

#include "basic/basic.h"

err_t tmc_report_read(const basic_arg_t *args, size_t count);
err_t tmc_report_write(const basic_arg_t *args, size_t count);

// PEEK(TMC driver, what).
err_t tmc_report_peek(const basic_arg_t *args, size_t count, basic_value_t *result);

#endif
