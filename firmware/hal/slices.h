// PWM slices, the same on every board: who owns which, and what makes a frequency. Context: main
// loop.
#ifndef HAL_SLICES_H
#define HAL_SLICES_H

#include "base/base.h"
#include "hal/hal_io.h"

// Reserves the slice for `owner` (a constant text such as "STEPPER spindle"), who may have it
// already. Error: somebody else has it - the message names who. Fails without changing anything.
err_t slices_claim(unsigned slice, const char *owner);
void slices_disclaim(unsigned slice);

// Who has it; NULL: nobody.
const char *slices_owner(unsigned slice);

// Divider and top with about the finest resolution that `frequency_hz` allows. Returns the
// frequency that comes of it; 0: it is out of reach.
double slices_divide(uint32_t clock_hz, double frequency_hz, bool phase_correct, hal_pwm_t *pwm);

// The lowest and the highest frequency that slices_divide() makes without phase_correct.
double slices_lowest_hz(uint32_t clock_hz);
double slices_highest_hz(uint32_t clock_hz);

#endif
