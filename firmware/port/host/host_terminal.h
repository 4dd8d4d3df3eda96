// Puts the user's terminal into raw mode, so that the firmware's line editor gets every key.
#ifndef HOST_TERMINAL_H
#define HOST_TERMINAL_H

#include <stdbool.h>

// If stdin is a terminal: no echo, no lines, no signal keys but Ctrl-\. Undone at exit, on crashes
// and while the program is stopped. Context: main.
void host_terminal_raw(void);

// Gives the terminal its settings back. Any context, signal handlers too.
void host_terminal_restore(void);

// True between the two.
bool host_terminal_is_raw(void);

#endif
