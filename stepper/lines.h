// Line numbers of queue entries in 16 bits each. Inside stepper/ only. Context: main.
#ifndef STEPPER_LINES_H
#define STEPPER_LINES_H

#include <stdint.h>

// The number of the entries to come; 0: none.
void lines_set(uint32_t number);

// The queue is empty and counts from 0 again.
void lines_restart(void);

// What the entry that is about to be published gets.
uint16_t lines_code(void);

// The number of the `entry`th entry ever published, which got `code`; 0: none, or too long ago.
uint32_t lines_number(uint32_t entry, uint16_t code);

#endif
