// The simulated pads. A pad shows, in this order: what the firmware drives (an output), what the
// outside world drives, the pull; an unconnected input without pull-up is low. Context: any.
#ifndef HOST_PADS_H
#define HOST_PADS_H

#include <stdbool.h>
#include <stdint.h>

// The outside world drives a pin from now on, or lets go of it. While the pin is an output the
// firmware wins and this level is seen when it becomes an input.
void host_pads_drive(unsigned gpio, bool level);
void host_pads_let_go(unsigned gpio);

#endif
