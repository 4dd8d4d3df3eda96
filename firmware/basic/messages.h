// What the console tells the user besides the output of programs: errors, and notices from outside
// (basic_printf() and basic_notice() of basic.h are here too). Context: main loop.
#ifndef BASIC_MESSAGES_H
#define BASIC_MESSAGES_H

#include "base/base.h"

// Forgets the notices that wait.
void messages_start(void);

// Shows the notices that came while nothing could be printed, if now it can.
void messages_show_notices(void);

// Prints err_message(), below the source line if it was a statement of the program.
void messages_error(void);

// The same for an error that belongs to no statement; nothing for ERR_OK. Returns `error`.
err_t messages_report(err_t error);

#endif
