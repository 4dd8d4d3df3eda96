// How time passes while the firmware waits. Context: main.
#ifndef HOST_IDLE_H
#define HOST_IDLE_H

#include <stdbool.h>

// Real time: virtual time follows wall time from now on. Otherwise it jumps from event to event.
void host_idle_init(bool realtime);

#endif
