// Where the editor's text comes from and goes to: the program, or a file. Context: main loop.
#ifndef BASIC_EDITOR_STORE_H
#define BASIC_EDITOR_STORE_H

#include <stddef.h>

#include "base/base.h"

// Whether it can be edited. A file that is not there is a new one. Error: why it cannot be read.
err_t editor_store_check(const char *file);

// Bytes it will have, about; 0 if there is nothing.
size_t editor_store_size(const char *file);

// Fills the (empty) text. Error: too long, not readable.
err_t editor_store_load(const char *file);

// Keeps the text. Without an error it is gone from the editor's memory.
err_t editor_store_save(const char *file);

#endif
