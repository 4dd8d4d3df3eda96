// The alarm, as a plain call at its virtual time. Context: any.
#ifndef HOST_ALARM_H
#define HOST_ALARM_H

#include <stdint.h>

// HOST_CLOCK_NEVER if none is set.
uint64_t host_alarm_next_ns(void);

// Its time has come.
void host_alarm_run(void);

#endif
