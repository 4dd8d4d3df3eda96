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

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c | 0x20) : c;
}

bool file_names_match(const char *pattern, const char *name) {
    const char *star = NULL; // the last * met, and where it was tried up to
    const char *tried = NULL;
    while (*name != '\0') {
        if (*pattern == '*') {
            star = pattern++;
            tried = name;
        } else if (*pattern == '?' || (*pattern != '\0' && lower(*pattern) == lower(*name))) {
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

static bool is_wanted(const files_entry_t *entry, const char *pattern, file_names_kind_t kind) {
    bool of_kind = kind == FILE_NAMES_ALL || entry->is_folder == (kind == FILE_NAMES_FOLDERS);
    return of_kind && file_names_match(pattern, entry->name);
}

bool file_names_next(const char *folder, const char *pattern, file_names_kind_t kind,
                     const char *after, files_entry_t *entry) {
    if (files_list_start(folder) != ERR_OK) {
        errors_fail_raised();
    }
    bool found = false;
    files_entry_t seen;
    while (files_list_next(&seen)) {
        bool first = strcmp(seen.name, after) > 0 && (!found || strcmp(seen.name, entry->name) < 0);
        if (first && is_wanted(&seen, pattern, kind)) {
            *entry = seen;
            found = true;
        }
    }
    return found;
}
