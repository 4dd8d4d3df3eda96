// Included before each file under test: its locks of the governor get the name of the function they
// are in.
#ifndef PREEMPT_LOCKS_H
#define PREEMPT_LOCKS_H

#include "hal/hal.h"

void preempt_lock(const char *function);

#define hal_governor_lock() preempt_lock(__func__)

#endif
