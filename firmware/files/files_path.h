// Paths as the user writes them, made absolute. Inside files/ only. Context: main loop.
#ifndef FILES_PATH_H
#define FILES_PATH_H

#include "files/files.h"

typedef struct {
    char text[FILES_PATH_MAX + 1]; // "/folder/name", without . and ..; "/" for the root
} files_path_t;

// Error: no name that can be.
err_t files_path_resolve(const char *path, files_path_t *out);

// The same for a folder that has to be there. Errors: not found, not a folder.
err_t files_path_resolve_folder(const char *path, files_path_t *out);

// Both absolute: `path` is this folder or somewhere in it.
bool files_path_is_inside(const char *path, const char *folder);

#endif
