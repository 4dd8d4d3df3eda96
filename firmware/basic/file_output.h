// A file that is written as a whole or not at all: until the end the old one is there, also after a
// power cut. One at a time. Context: main loop.
#ifndef BASIC_FILE_OUTPUT_H
#define BASIC_FILE_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/base.h"

// `path` must stay valid until the end.
err_t file_output_start(const char *path);
err_t file_output_write(const void *bytes, size_t size);

// Makes what was written the file's content if `error` is ERR_OK, otherwise leaves the file as it
// was. Returns `error`, which stays the one that was raised last, or what closing it says.
err_t file_output_end(err_t error);

#endif
