// Names of files, and files that are replaced as a whole. Context: main loop.
#include "files_names.h"

#include <string.h>

#include "files/files.h"
#include "files_path.h"
#include "files_volume.h"
#include "hal/hal.h"

#define REPLACEMENT "/.new" // a new content until it is complete

static lfs_ssize_t do_remove(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_remove(lfs, call->path);
}

err_t files_names_remove(const char *path) {
    files_volume_call_t call = {.path = path};
    return files_volume_write(do_remove, &call, NULL);
}

static lfs_ssize_t do_rename(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_rename(lfs, call->path, call->to);
}

static lfs_ssize_t do_info(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_stat(lfs, call->path, call->info);
}

// What a power cut left behind.
void files_names_clean_up(void) {
    struct lfs_info info;
    files_volume_call_t call = {.path = REPLACEMENT, .info = &info};
    if (files_volume_read(do_info, &call, NULL) == ERR_OK) {
        files_names_remove(REPLACEMENT);
    }
}

// ---- Whole files --------------------------------------------------------------------------------

// A file can be here, or is: its folder is there and it is not in use.
static err_t check_place(const files_path_t *place) {
    files_path_t folder = *place;
    files_entry_t entry;
    *strrchr(folder.text, '/') = '\0';
    err_t error = files_info(folder.text[0] != '\0' ? folder.text : "/", &entry);
    if (error == ERR_OK && entry.is_folder && files_info(place->text, &entry) == ERR_OK &&
        entry.is_folder) {
        error = ERR_IS_A_FOLDER;
    }
    return error != ERR_OK ? err_raise(error, "%s", place->text)
                           : files_names_check_unused(place->text);
}

err_t files_begin_replacement(const char *path, int *number) {
    files_path_t place;
    err_t error = files_path_resolve(path, &place);
    if (error == ERR_OK) {
        error = check_place(&place);
    }
    return error == ERR_OK ? files_open(REPLACEMENT, FILES_WRITE, number) : error;
}

static err_t rename_replacement(const char *path) {
    files_path_t place;
    err_t error = files_path_resolve(path, &place);
    if (error == ERR_OK) {
        error = files_names_check_unused(place.text);
    }
    if (error != ERR_OK) {
        return error;
    }
    files_volume_call_t call = {.path = REPLACEMENT, .to = place.text};
    error = files_volume_write(do_rename, &call, NULL);
    return error != ERR_OK ? err_raise(error, "%s", place.text) : ERR_OK;
}

err_t files_commit_replacement(int number, const char *path) {
    if (!hal_storage_is_writable()) { // closing it would only be put off
        files_abandon(number);
        return err_raise(ERR_STORAGE_BUSY, NULL);
    }
    err_t error = files_close(number);
    return error == ERR_OK ? rename_replacement(path) : error;
}

err_t files_replace(const char *path, const void *bytes, size_t size) {
    int number;
    err_t error = files_begin_replacement(path, &number);
    if (error != ERR_OK) {
        return error;
    }
    error = files_write(number, bytes, size);
    if (error != ERR_OK) {
        files_abandon(number);
        return error;
    }
    return files_commit_replacement(number, path);
}

// ---- Names --------------------------------------------------------------------------------------

err_t files_remove(const char *path) {
    files_path_t place;
    files_entry_t entry;
    err_t error = files_path_resolve(path, &place);
    if (error == ERR_OK) {
        error = files_info(path, &entry);
    }
    if (error == ERR_OK && entry.is_folder) {
        error = err_raise(ERR_IS_A_FOLDER, "%s", place.text);
    }
    if (error == ERR_OK) {
        error = files_names_check_unused(place.text);
    }
    return error != ERR_OK ? error : files_names_remove(place.text);
}

// littlefs would make a folder that is moved into itself, with all in it, unreachable.
static err_t check_movable(const char *folder, const char *to) {
    bool used = files_path_is_inside(to, folder) || files_path_is_inside(files_folder(), folder);
    return used ? err_raise(ERR_FOLDER_IN_USE, "%s", folder) : ERR_OK;
}

err_t files_rename(const char *from, const char *to) {
    files_path_t old, new;
    files_entry_t entry;
    err_t error = files_path_resolve(from, &old);
    if (error == ERR_OK) {
        error = files_path_resolve(to, &new);
    }
    if (error == ERR_OK) {
        error = files_info(from, &entry);
    }
    if (error == ERR_OK && entry.is_folder) {
        error = check_movable(old.text, new.text);
    } else if (error == ERR_OK) {
        error = files_names_check_unused(old.text);
    }
    if (error == ERR_OK && files_info(to, &entry) == ERR_OK) {
        error = err_raise(ERR_FILE_EXISTS, "%s", new.text);
    }
    files_volume_call_t call = {.path = old.text, .to = new.text};
    return error != ERR_OK ? error : files_volume_write(do_rename, &call, NULL);
}

err_t files_info(const char *path, files_entry_t *entry) {
    files_path_t place;
    err_t error = files_path_resolve(path, &place);
    struct lfs_info info = {.type = LFS_TYPE_DIR, .name = "/"};
    if (error == ERR_OK && place.text[1] != '\0') {
        files_volume_call_t call = {.path = place.text, .info = &info};
        error = files_volume_read(do_info, &call, NULL);
    }
    if (error == ERR_OK) {
        strcpy(entry->name, info.name);
        entry->is_folder = info.type == LFS_TYPE_DIR;
        entry->size = entry->is_folder ? 0 : info.size;
    }
    return error;
}
