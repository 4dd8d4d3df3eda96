// HELP: what the tables say about a command. Context: main loop.
#ifndef BASIC_HELP_H
#define BASIC_HELP_H

#include <stdbool.h>
#include <stddef.h>

#include "basic/basic.h"

// The names of all commands and statements, or of all functions.
void help_print_words(bool commands);

// Prints the list of commands for an empty topic, otherwise what there is about it.
void help_print(const char *topic, size_t length);

#endif
