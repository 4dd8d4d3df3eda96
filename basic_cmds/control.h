// Handlers that move and stop the machine. Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_CONTROL_H
#define BASIC_CMDS_CONTROL_H

#include "basic/basic.h"

err_t control_run(const basic_arg_t *args, size_t count);
err_t control_clear(const basic_arg_t *args, size_t count);
err_t control_stop(const basic_arg_t *args, size_t count);
err_t control_hold(const basic_arg_t *args, size_t count);
err_t control_resume(const basic_arg_t *args, size_t count);
err_t control_override(const basic_arg_t *args, size_t count);
err_t control_jog(const basic_arg_t *args, size_t count);
err_t control_jog_stop(const basic_arg_t *args, size_t count);
err_t control_estop(const basic_arg_t *args, size_t count);
// Waits as basic_wait() does, for what ends by itself: Ctrl-C asks for nothing else.
void control_wait(uint64_t until_us);
// Brings motion to a controlled stop and waits for it.
void control_await_stop(void);
err_t control_close(const basic_arg_t *args, size_t count);
err_t control_position_home(const basic_arg_t *args, size_t count);
err_t control_position(const basic_arg_t *args, size_t count);

// Where each argument stands in the row's spec.
enum { JOG_AXIS, JOG_DISTANCE, JOG_FEED, JOG_ARGS };

// Instead of a distance, in the order of these indexes.
#define JOG_CHOICES "+|-"
enum { JOG_UP, JOG_DOWN };

// OPTION ERROR; and an error has ended a program.
#define CONTROL_ERROR_CHOICES "STOP|RUN"
err_t control_option_error(const basic_arg_t *args, size_t count);
void control_error(void);

#endif
