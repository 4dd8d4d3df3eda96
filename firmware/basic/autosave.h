// AUTOSAVE: a program from the terminal. Context: main loop.
#ifndef BASIC_AUTOSAVE_H
#define BASIC_AUTOSAVE_H

#include <stdbool.h>

#include "base/base.h"

// Takes lines up to Ctrl-Z or F1, makes them the program and keeps them in flash. Ctrl-C leaves the
// old program as it was. *start becomes true if it is to run. `behind`: behind what the program
// has. Errors: too long, motion runs. What is pasted behind a refused AUTOSAVE is a program, not a
// list of commands for a machine in motion: it is taken in all the same and dropped.
// Afterwards program_compile_stored() is called for: the old program's code may have given way.
err_t autosave_read(bool behind, bool *start);

#endif
