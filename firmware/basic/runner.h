// Runs lines of the prompt, the program and single SUBs of it, and then does what they have asked
// for (requests.h). All errors are printed here; what is returned says how it ended. Context: main
// loop.
#ifndef BASIC_RUNNER_H
#define BASIC_RUNNER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/base.h"
#include "basic/basic.h"

// Takes on_break and on_error of the configuration.
void runner_start(const basic_config_t *config);

// A line typed at the prompt, and what it asks for.
void runner_line(const char *text, size_t length);

// The program, until it does not ask to be run again; its channels are closed then.
err_t runner_program(void);

bool runner_has_routine(const char *name);

// Calls a SUB without parameters as a part of the program: an error ends a program. ERR_OK if there
// is none of this name.
err_t runner_routine(const char *name);

// The same as if it was typed at the prompt.
err_t runner_prompt_routine(const char *name);

// Whether Ctrl-C has ended what ran last.
bool runner_was_broken(void);

// Does what the code that ran last has asked for, if anything (vm.request).
void runner_serve(void);

// Ctrl-C has come: a line of its own, and the machine stops.
void runner_break(void);

#endif
