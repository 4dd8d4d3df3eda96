// A session is one short life of the machine: it is set up, gets commands at the prompt and lines
// of G-code, is held, stopped and asked how it is, while interrupts come at random places of all
// that code. At its end everything that was accepted must have been carried out, exactly once and
// exactly.
#ifndef SESSION_H
#define SESSION_H

#include <stdbool.h>
#include <stdint.h>

#include "operations.h"

// Once in a process.
void session_start(void);

// The same seed, the same session. Ends the process with code 1 and a message if something is
// wrong.
void session_run(uint64_t seed);

// Sum over all sessions, to see that something happened.
typedef struct {
    operations_counts_t operations;
    uint64_t lines, positions, steps;
} session_counts_t;

extern session_counts_t session_counts;

#endif
