// Slices and their pins. Inside firmware/io only. Context: main loop.
#ifndef IO_IO_SLICES_H
#define IO_IO_SLICES_H

#include "hal/hal_io.h"

// The pin is not its slice's any more; with the last one the slice stops.
void io_slices_remove(unsigned gpio);

// Divider and top with about the finest resolution that `frequency_hz` allows. Returns the
// frequency that comes of it; 0: it is out of reach.
double io_slices_divide(uint32_t clock_hz, double frequency_hz, bool phase_correct, hal_pwm_t *pwm);

// The lowest and the highest frequency that io_slices_divide() makes.
double io_slices_lowest_hz(uint32_t clock_hz);
double io_slices_highest_hz(uint32_t clock_hz);

#endif
