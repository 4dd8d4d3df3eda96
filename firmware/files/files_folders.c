// Folders, their lists, and the space that is left. Context: main loop.
#include <string.h>

#include "files/files.h"
#include "files_names.h"
#include "files_path.h"
#include "files_volume.h"
#include "hal/hal.h"

static struct {
    lfs_dir_t folder;
    bool open;
    unsigned generation;
    unsigned number;
} list;

static lfs_ssize_t do_make(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_mkdir(lfs, call->path);
}

static lfs_ssize_t do_open_list(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_dir_open(lfs, call->folder, call->path);
}

static lfs_ssize_t do_read_list(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_dir_read(lfs, call->folder, call->info);
}

static lfs_ssize_t do_close_list(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_dir_close(lfs, call->folder);
}

static lfs_ssize_t do_measure(lfs_t *lfs, const files_volume_call_t *call) {
    (void)call;
    return lfs_fs_size(lfs);
}

err_t files_make_folder(const char *path) {
    files_path_t place;
    err_t error = files_path_resolve(path, &place);
    files_volume_call_t call = {.path = place.text};
    return error != ERR_OK ? error : files_volume_write(do_make, &call, NULL);
}

err_t files_remove_folder(const char *path) {
    files_path_t place;
    err_t error = files_path_resolve_folder(path, &place);
    if (error == ERR_OK && files_path_is_inside(files_folder(), place.text)) {
        error = err_raise(ERR_FOLDER_IN_USE, "%s", place.text);
    }
    return error != ERR_OK ? error : files_names_remove(place.text);
}

// ---- Lists --------------------------------------------------------------------------------------

static void end_list(void) {
    if (list.open && list.generation == files_volume_generation()) {
        files_volume_call_t call = {.folder = &list.folder};
        files_volume_read(do_close_list, &call, NULL);
    }
    list.open = false;
}

err_t files_list_start(const char *folder) {
    end_list();
    list.number++;
    files_path_t place;
    err_t error = files_path_resolve_folder(folder, &place);
    if (error != ERR_OK) {
        return error;
    }
    files_volume_call_t call = {.folder = &list.folder, .path = place.text};
    lfs_ssize_t result;
    error = files_volume_read(do_open_list, &call, &result);
    list.open = error == ERR_OK;
    list.generation = files_volume_generation();
    return result == LFS_ERR_NOENT ? ERR_OK : error; // no file system yet: an empty root
}

unsigned files_list_number(void) {
    return list.number;
}

bool files_list_next(files_entry_t *entry) {
    struct lfs_info info;
    files_volume_call_t call = {.folder = &list.folder, .info = &info};
    lfs_ssize_t result;
    do {
        if (!list.open || list.generation != files_volume_generation() ||
            files_volume_read(do_read_list, &call, &result) != ERR_OK || result == 0) {
            end_list();
            return false;
        }
    } while (info.name[0] == '.'); // the folder, the one above, and what is not the user's
    strcpy(entry->name, info.name);
    entry->is_folder = info.type == LFS_TYPE_DIR;
    entry->size = entry->is_folder ? 0 : info.size;
    return true;
}

err_t files_space(uint32_t *total, uint32_t *used) {
    files_volume_call_t call = {0};
    lfs_ssize_t blocks;
    err_t error = files_volume_read(do_measure, &call, &blocks);
    *total = FILES_VOLUME_BLOCKS * HAL_STORAGE_SECTOR;
    *used = error == ERR_OK ? (uint32_t)blocks * HAL_STORAGE_SECTOR : 0;
    return blocks == LFS_ERR_NOENT ? ERR_OK : error;
}
