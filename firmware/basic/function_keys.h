// What the function keys type at the prompt: some from the start, others by OPTION F5 "text". The
// user's are kept in a file of A:. Context: main loop.
#ifndef BASIC_FUNCTION_KEYS_H
#define BASIC_FUNCTION_KEYS_H

#include <stddef.h>

#include "base/base.h"

#define FUNCTION_KEYS_COUNT 12
#define FUNCTION_KEYS_TEXT_MAX 64

// Puts the text of key `number` (from 1) to `text`, of at least FUNCTION_KEYS_TEXT_MAX bytes.
// Returns its length; 0 if it has none.
size_t function_keys_get(unsigned number, char *text);

// Keeps another text; with no text the key does again what it did at first. For a statement.
// Errors: of the file.
err_t function_keys_set(unsigned number, const char *text, size_t length);

// All keys as they were at first.
err_t function_keys_reset(void);

// Prints those that the user has set, as the statements that set them.
void function_keys_list(void);

#endif
