// Generates BASIC programs that are right for the most part: nested blocks, SUBs and FUNCTIONs with
// arguments by reference, arrays, texts that are executed, files, events, errors that are skipped.
#ifndef FUZZ_PROGRAM_H
#define FUZZ_PROGRAM_H

#include "fuzz_text.h"

// A whole program, typed in behind AUTOSAVE and started by RUN.
void fuzz_program(fuzz_text_t *text);

// One line for the prompt, of the same grammar.
void fuzz_program_line(fuzz_text_t *text);

#endif
