// Slices and their pins. Inside firmware/io only. Context: main loop.
#ifndef IO_IO_SLICES_H
#define IO_IO_SLICES_H

#include "hal/hal_io.h"

// The pin is not its slice's any more; with the last one the slice stops.
void io_slices_remove(unsigned gpio);

#endif
