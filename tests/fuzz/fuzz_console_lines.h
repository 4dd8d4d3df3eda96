// Lines for the prompt: commands from the product's own rows, BASIC, whole programs, and rubbish.
#ifndef FUZZ_CONSOLE_LINES_H
#define FUZZ_CONSOLE_LINES_H

#include <stdbool.h>

#include "fuzz_text.h"

// A line that sets the machine up, so that most sessions have motion; `index` counts from 0. False
// if there is none left.
bool fuzz_console_setup_line(fuzz_text_t *text, unsigned index);

// One command of the rows, arguments made from its specification: mostly valid, at the limits or
// beyond. No other statement is in the line.
void fuzz_console_command(fuzz_text_t *text);

// Statements and expressions of BASIC.
void fuzz_console_basic(fuzz_text_t *text);

// A program typed in after AUTOSAVE, and RUN: several lines, ended by Ctrl-Z.
void fuzz_console_program(fuzz_text_t *text);

// Bytes and control keys, editing sequences among them; always ends with Ctrl-U, so that what comes
// next starts on an empty line.
void fuzz_console_keys(fuzz_text_t *text);

#endif
