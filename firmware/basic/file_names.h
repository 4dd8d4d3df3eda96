// Names of files as a program gives them: paths, patterns, lists. Context: main loop.
#ifndef BASIC_FILE_NAMES_H
#define BASIC_FILE_NAMES_H

#include <stdbool.h>

#include "files/files.h"
#include "value.h"

// The value as a path, zero-terminated, valid until the statement ends. Error: no string, or a zero
// in it.
const char *file_names_path(const value_t *value);

bool file_names_is_pattern(const char *path);

// "folder/*.nc" cut in two: the folder (kept until the statement ends) and the pattern, which is a
// part of `path`.
const char *file_names_split(const char *path, const char **pattern);

// Which entries a list takes.
typedef enum { FILE_NAMES_FILES, FILE_NAMES_FOLDERS, FILE_NAMES_ALL } file_names_kind_t;

// The next entry of the list whose name fits the pattern (* is any text, ? any character, capitals
// do not matter); false: there is none.
bool file_names_next(const char *pattern, file_names_kind_t kind, files_entry_t *entry);

// <0, 0, >0: how two names follow each other in a list.
int file_names_order(const char *left, const char *right);

#endif
