// What the files' names and their handles need of each other. Inside files/ only. Context: main
// loop.
#ifndef FILES_NAMES_H
#define FILES_NAMES_H

#include "base/base.h"

// Error: the file is open. The path is absolute.
err_t files_names_check_unused(const char *path);

// Removes a file or an empty folder, unasked. The path is absolute.
err_t files_names_remove(const char *path);

// Removes what a power cut left of a replacement.
void files_names_clean_up(void);

#endif
