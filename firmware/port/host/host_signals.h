// Signals, made into flags that are looked at where it is safe to act on them.
#ifndef HOST_SIGNALS_H
#define HOST_SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

// From now on SIGTERM, SIGHUP and SIGQUIT end the program in order (a second one at once), SIGINT
// is a Ctrl-C for the firmware (a second one within 2 s ends the program) and SIGPIPE is ignored.
void host_signals_init(void);

// Leaves the program with 128 + number if a signal asked for it. Context: main.
void host_signals_check(void);

// True if a signal wants the program to end; leaving must not wait for anybody then.
bool host_signals_leaving(void);

// True if a SIGINT has come for the firmware.
bool host_signals_interrupted(void);

// Forgets that SIGINT.
void host_signals_take_interrupt(void);

// Sleeps until `read_file` can be read, `write_file` be written (-1: none), for `timeout_ns`
// (UINT64_MAX: no limit), or until a signal comes, with no window in which one could be missed.
void host_signals_wait(int read_file, int write_file, uint64_t timeout_ns);

// Monotonic wall-clock time. Any context, signal handlers too.
uint64_t host_signals_wall_ns(void);

#endif
