// What a session does with the machine, one thing after the other, by chance. Context: main loop.
#ifndef OPERATIONS_H
#define OPERATIONS_H

#include <stdint.h>

typedef struct {
    uint64_t refused, moves, stops, holds;
} operations_counts_t;

extern operations_counts_t operations_counts;

void operations_do_one(void);

// RESUME if held, RUN if disarmed.
void operations_resume(void);
void operations_arm(void);

#endif
