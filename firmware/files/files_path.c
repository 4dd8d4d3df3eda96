// Paths and the current folder. Context: main loop.
#include "files_path.h"

#include <string.h>

static files_path_t folder = {"/"};

const char *files_folder(void) {
    return folder.text;
}

static bool is_separator(char c) {
    return c == '/' || c == '\\';
}

static bool is_allowed(char c) {
    return (unsigned char)c >= ' ' && c != 0x7F && strchr(":*?\"<>|", c) == NULL;
}

static bool is_name(const char *name, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (!is_allowed(name[i])) {
            return false;
        }
    }
    return length <= FILES_NAME_MAX;
}

// One step from the folder that `out` is. False: no name, or the path is too long.
static bool append(files_path_t *out, const char *name, size_t length) {
    size_t end = strlen(out->text);
    if (length == 0 || (length == 1 && name[0] == '.')) {
        return true;
    }
    if (length == 2 && memcmp(name, "..", 2) == 0) {
        *strrchr(out->text, '/') = '\0';
        if (out->text[0] == '\0') {
            strcpy(out->text, "/");
        }
        return true;
    }
    bool root = end == 1;
    if (!is_name(name, length) || end + !root + length > FILES_PATH_MAX) {
        return false;
    }
    if (!root) {
        out->text[end++] = '/';
    }
    memcpy(out->text + end, name, length);
    out->text[end + length] = '\0';
    return true;
}

err_t files_path_resolve(const char *path, files_path_t *out) {
    const char *rest = path;
    if ((rest[0] | 0x20) == 'a' && rest[1] == ':') {
        rest += 2;
    }
    *out = folder;
    if (is_separator(*rest)) {
        strcpy(out->text, "/");
    }
    bool good = *path != '\0';
    while (good && *rest != '\0') {
        const char *end = rest;
        while (*end != '\0' && !is_separator(*end)) {
            end++;
        }
        good = append(out, rest, (size_t)(end - rest));
        rest = *end != '\0' ? end + 1 : end;
    }
    return good ? ERR_OK : err_raise(ERR_FILE_BAD_NAME, "%s", path);
}

err_t files_path_resolve_folder(const char *path, files_path_t *out) {
    files_entry_t entry;
    err_t error = files_path_resolve(path, out);
    if (error == ERR_OK) {
        error = files_info(path, &entry);
    }
    if (error == ERR_OK && !entry.is_folder) {
        error = err_raise(ERR_NOT_A_FOLDER, "%s", out->text);
    }
    return error;
}

bool files_path_is_inside(const char *path, const char *inside) {
    size_t length = strlen(inside);
    bool root = length == 1;
    return strncmp(path, inside, length) == 0 &&
           (root || path[length] == '\0' || path[length] == '/');
}

err_t files_change_folder(const char *path) {
    files_path_t to;
    err_t error = files_path_resolve_folder(path, &to);
    if (error == ERR_OK) {
        folder = to;
    }
    return error;
}
