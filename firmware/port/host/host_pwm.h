// The simulated PWM slices. Their edges are no events: levels and rows of the trace are computed
// when they are wanted, so that a spindle at 20 kHz costs nothing while nobody looks. New settings
// of a running slice count at once, not from its next period on. Context: any.
#ifndef HOST_PWM_H
#define HOST_PWM_H

#include <stdint.h>

#include "hal/hal_io.h"

// Gives a pin to its slice, or takes it back (no effect if it was not).
void host_pwm_add(unsigned gpio);
void host_pwm_remove(unsigned gpio);

// Masks: the pins that belong to a slice, and their levels now.
uint32_t host_pwm_pins(void);
uint32_t host_pwm_levels(void);

// What a slice was given last.
const hal_pwm_t *host_pwm_settings(unsigned slice);

// Writes the edges up to and including `until_ns` into the trace.
void host_pwm_record(uint64_t until_ns);

#endif
