// Names of files. Context: main loop.
#include "file_names.h"

#include <string.h>

#include "errors.h"
#include "memory.h"

const char *file_names_path(const value_t *value) {
    if (value->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    char *path = memory_text(value->length + 1);
    memcpy(path, value->text, value->length);
    path[value->length] = '\0';
    if (strlen(path) != value->length) {
        errors_fail_with(ERR_FILE_BAD_NAME, "%s", path);
    }
    return path;
}

bool file_names_is_pattern(const char *path) {
    return strpbrk(path, "*?") != NULL;
}

const char *file_names_split(const char *path, const char **pattern) {
    *pattern = path;
    for (const char *p = path; *p != '\0'; p++) {
        bool drive = p == path + 1 && *p == ':';
        *pattern = *p == '/' || *p == '\\' || drive ? p + 1 : *pattern;
    }
    size_t length = (size_t)(*pattern - path);
    if (length == 0) {
        return ".";
    }
    char *folder = memory_text(length + 1);
    memcpy(folder, path, length);
    folder[length] = '\0';
    return folder;
}

// `pattern` may have * and ?.
static bool matches(const char *pattern, const char *name) {
    const char *star = NULL; // the last * met, and where it was tried up to
    const char *tried = NULL;
    while (*name != '\0') {
        if (*pattern == '*') {
            star = pattern++;
            tried = name;
        } else if (*pattern == '?' ||
                   (*pattern != '\0' && letters_lower(*pattern) == letters_lower(*name))) {
            pattern++;
            name++;
        } else if (star != NULL) {
            pattern = star + 1;
            name = ++tried;
        } else {
            return false;
        }
    }
    while (*pattern == '*') {
        pattern++;
    }
    return *pattern == '\0';
}

bool file_names_next(const char *pattern, file_names_kind_t kind, files_entry_t *entry) {
    while (files_list_next(entry)) {
        bool of_kind = kind == FILE_NAMES_ALL || entry->is_folder == (kind == FILE_NAMES_FOLDERS);
        if (of_kind && matches(pattern, entry->name)) {
            return true;
        }
    }
    return false;
}

int file_names_order(const char *left, const char *right) {
    size_t of_left = strlen(left);
    size_t of_right = strlen(right);
    int order = memcmp(left, right, of_left < of_right ? of_left : of_right);
    return order != 0 ? order : (int)of_right - (int)of_left;
}
