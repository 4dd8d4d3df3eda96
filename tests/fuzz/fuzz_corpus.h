// Seed inputs from files: one input a line, so that a line that once did harm is kept by adding it.
#ifndef FUZZ_CORPUS_H
#define FUZZ_CORPUS_H

#include <stdbool.h>

#include "fuzz_text.h"

typedef enum { FUZZ_CORPUS_GCODE, FUZZ_CORPUS_CONSOLE, FUZZ_CORPUS_COUNT } fuzz_corpus_kind_t;

// Reads `directory`/gcode.txt and console.txt. False, after a message, if one is missing or empty.
bool fuzz_corpus_load(const char *directory);

// Puts a random seed of that kind into `text`.
void fuzz_corpus_pick(fuzz_corpus_kind_t kind, fuzz_text_t *text);

#endif
