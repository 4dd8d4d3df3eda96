// G-code lines for the tests of gcode/.
#ifndef LINES_H
#define LINES_H

#include "base/base.h"

err_t lines_send(const char *text);

// Sends a line that has to be accepted.
void lines_check_ok(const char *text);

#endif
