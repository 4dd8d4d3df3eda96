// Homing as a cycle. Inside stepper/ only. Context: main loop.
#ifndef STEPPER_HOMING_H
#define STEPPER_HOMING_H

#include "stepper/home_config.h"

// At a standstill: what is next.
void homing_advance(void);
void homing_end(bool done);

#endif
