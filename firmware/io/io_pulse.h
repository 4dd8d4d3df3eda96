// Pulses under way. Inside firmware/io only.
#ifndef IO_IO_PULSE_H
#define IO_IO_PULSE_H

#include <stdint.h>

// The pin's level is about to be set otherwise: no end of a pulse will change it. Context: main.
void io_pulse_forget(unsigned gpio);

// When the next one ends; UINT64_MAX: none is under way. Context: alarm, or main with the alarm
// locked.
uint64_t io_pulse_next_us(void);

// Ends those that are due. Context: alarm.
void io_pulse_run(uint64_t now_us);

#endif
