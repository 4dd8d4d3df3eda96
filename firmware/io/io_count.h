// Pins that count. Inside firmware/io only. Context: main loop unless said otherwise.
#ifndef IO_IO_COUNT_H
#define IO_IO_COUNT_H

#include <stdint.h>

// Readings of a pin that is used so.
double io_count_hz(unsigned gpio);
double io_count_period_ms(unsigned gpio);
int64_t io_count_edges(unsigned gpio);
void io_count_set(unsigned gpio, int64_t edges);

// Gives the pin's counter back.
void io_count_stop(unsigned gpio);

// When a gate closes next; UINT64_MAX: none is open. Context: alarm, or main with the alarm locked.
uint64_t io_count_next_us(void);

// Closes those that are due. Context: alarm.
void io_count_run(uint64_t now_us);

#endif
