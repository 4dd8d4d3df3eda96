// Readings of analog inputs. Inside firmware/io only. Context: main loop.
#ifndef IO_IO_ANALOG_H
#define IO_IO_ANALOG_H

#include <stdint.h>

double io_analog_volts(unsigned gpio); // of several conversions
int64_t io_analog_raw(unsigned gpio);  // one conversion

#endif
