// What homing asks of whoever arms the drivers, and what of that is still to be undone. Inside
// stepper/ only. Context: main loop.
#ifndef STEPPER_HOMING_HOOK_H
#define STEPPER_HOMING_HOOK_H

#include "stepper/stepper_homing.h"

// Whether the axes can be homed; raises why not.
err_t homing_hook_check(uint32_t axes);

// Brings the drivers of `axes` (those armed before, without `on`) to where they should be. Done at
// once if they are there.
stepper_arm_t homing_hook_arm(uint32_t axes, bool on);

// The cycle has ended: what is armed is now left over.
void homing_hook_end(void);

// Takes on the disarming of what earlier cycles have left over. Done: there is nothing.
stepper_arm_t homing_hook_tidy(void);

#endif
