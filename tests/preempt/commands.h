// Commands for the machine under test, as somebody at its prompt gives them. Context: main loop.
#ifndef COMMANDS_H
#define COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

// Starts BASIC with nobody at the other end of the console. Once in a process.
void commands_start(void);

// Carries out a line of BASIC. An error is ERR_ARGUMENT, whatever it is; see
// commands_refused_for().
err_t command(const char *format, ...) __attribute__((format(printf, 1, 2)));

// The same; it must be accepted.
void must(const char *line);

// The last error was this one, one whose text has no details.
bool refused_for(err_t code);

extern uint64_t commands_count;

#endif
