// Keeps the program in the flash storage, so that it survives power-off. Two places take turns: the old
// program is there until the new one is complete. Context: main loop.
#ifndef BASIC_PROGRAM_STORAGE_H
#define BASIC_PROGRAM_STORAGE_H

#include <stddef.h>

#include "base/base.h"

// Longest program that can be kept.
#define PROGRAM_STORAGE_MAX (128u * 1024u - 256u)

// Writes it. Errors: motion runs, the flash failed.
err_t program_storage_save(const char *text, size_t length);

// Reads it to `text` (up to `size` bytes). *length is 0 if there is none.
// Error: what is there is damaged.
err_t program_storage_load(char *text, size_t size, size_t *length);

#endif
