// What CPU RESTART needs to know. Context: main loop.
#ifndef BASIC_MACHINE_H
#define BASIC_MACHINE_H

#include "base/base.h"

// `may_restart` (NULL: always) is asked before a restart; an error it raises refuses it.
void machine_start(err_t (*may_restart)(void));

#endif
