// Probing as a cycle. Inside stepper/ only. Context: main loop.
#ifndef STEPPER_PROBING_H
#define STEPPER_PROBING_H

#include "stepper/stepper_homing.h"

// At a standstill: what is next.
void probing_advance(void);
void probing_end(bool done);

// INIT: no probe, nothing probed. The pin has been given back (probing_release).
void probing_reset(void);
void probing_release(void);

#endif
