// The way back to the prompt for a board whose program does not let anybody in. Context: main loop.
#ifndef BASIC_BOOT_H
#define BASIC_BOOT_H

#include <stdbool.h>

// At power-up: false if the program must not be started, because the firmware crashed or hung the
// last time or because the user says so by Ctrl-C. If that key does not end a running program
// (OPTION BREAK) there are some seconds for it.
bool boot_is_wanted(void);

#endif
