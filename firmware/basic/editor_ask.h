// Questions at the bottom of the editor's screen. Context: main loop.
#ifndef BASIC_EDITOR_ASK_H
#define BASIC_EDITOR_ASK_H

#include <stdbool.h>
#include <stddef.h>

// Asks for a text; what `answer` (of `size` bytes) holds stays unless something is typed.
// `same_key` is taken as Enter. False: given up.
bool editor_ask_text(const char *question, char *answer, size_t size, int same_key);

// Asks for one of the keys (capital letters). Returns it, or '\0' if it was given up.
char editor_ask_key(const char *question, const char *keys);

#endif
