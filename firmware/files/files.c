// Open files, and when they may be written. Context: main loop.
#include "files/files.h"

#include <string.h>

#include "files_names.h"
#include "files_path.h"
#include "files_volume.h"
#include "hal/hal.h"

typedef struct {
    lfs_file_t file;
    struct lfs_file_config config;
    uint8_t buffer[FILES_BUFFER];
    uint8_t mode;        // files_mode_t
    bool open;           // for littlefs
    bool closing;        // closed by the user; waits for motion to end
    unsigned generation; // of the volume when it was opened
} handle_t;

static struct {
    handle_t handles[FILES_OPEN_MAX];
    unsigned closing;
} files;

static err_t call_volume(bool writes, files_volume_work_t work, const files_volume_call_t *call,
                         lfs_ssize_t *result) {
    return writes ? files_volume_write(work, call, result) : files_volume_read(work, call, result);
}

static lfs_ssize_t do_open(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_file_opencfg(lfs, call->file, call->path, call->flags, call->config);
}

static lfs_ssize_t do_close(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_file_close(lfs, call->file);
}

static lfs_ssize_t do_sync(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_file_sync(lfs, call->file);
}

static lfs_ssize_t do_read(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_file_read(lfs, call->file, call->bytes, call->size);
}

// A full disk is found before a further block is begun, so all that came until then is in order.
// Marked as faulty the file would be left as it was when it was opened.
static lfs_ssize_t do_write(lfs_t *lfs, const files_volume_call_t *call) {
    lfs_ssize_t result = lfs_file_write(lfs, call->file, call->source, call->size);
    if (result == LFS_ERR_NOSPC) {
        call->file->flags &= ~(uint32_t)LFS_F_ERRED;
    }
    return result;
}

static lfs_ssize_t do_seek(lfs_t *lfs, const files_volume_call_t *call) {
    return lfs_file_seek(lfs, call->file, (lfs_soff_t)call->size, LFS_SEEK_SET);
}

// ---- Start --------------------------------------------------------------------------------------

err_t files_start(void) {
    memset(&files, 0, sizeof files);
    if (!files_volume_start()) {
        return err_raise(ERR_FILES_DAMAGED, NULL);
    }
    files_names_clean_up();
    files_change_folder("/");
    return ERR_OK;
}

err_t files_format(void) {
    err_t error = files_volume_format();
    if (error == ERR_OK) {
        memset(&files, 0, sizeof files);
        files_change_folder("/");
    }
    return error;
}

// ---- Opening ------------------------------------------------------------------------------------

static bool is_same(const lfs_file_t *a, const lfs_file_t *b) {
    bool pair = (a->m.pair[0] == b->m.pair[0] && a->m.pair[1] == b->m.pair[1]) ||
                (a->m.pair[0] == b->m.pair[1] && a->m.pair[1] == b->m.pair[0]);
    return pair && a->id == b->id;
}

static bool is_lost(const handle_t *handle) {
    return handle->generation != files_volume_generation();
}

static bool is_opened(const lfs_file_t *file, bool for_writing) {
    for (size_t i = 0; i < FILES_OPEN_MAX; i++) {
        const handle_t *handle = &files.handles[i];
        if (handle->open && !is_lost(handle) && &handle->file != file &&
            (for_writing || handle->mode != FILES_READ) && is_same(&handle->file, file)) {
            return true;
        }
    }
    return false;
}

// littlefs would let a file be changed under the feet of those who read it.
err_t files_names_check_unused(const char *path) {
    lfs_file_t file;
    uint8_t buffer[FILES_BUFFER];
    struct lfs_file_config config = {.buffer = buffer};
    files_volume_call_t call = {
        .path = path, .file = &file, .config = &config, .flags = LFS_O_RDONLY};
    if (files_volume_read(do_open, &call, NULL) != ERR_OK) {
        return ERR_OK; // a folder, or nothing: littlefs will tell
    }
    bool used = is_opened(&file, true);
    files_volume_read(do_close, &call, NULL);
    return used ? err_raise(ERR_FILE_IN_USE, "%s", path) : ERR_OK;
}

static handle_t *free_handle(int *number) {
    for (int i = 0; i < FILES_OPEN_MAX; i++) {
        if (!files.handles[i].open) {
            *number = i;
            return &files.handles[i];
        }
    }
    return NULL;
}

static err_t open_handle(handle_t *handle, const char *path, files_mode_t mode) {
    static const int flags[] = {
        [FILES_READ] = LFS_O_RDONLY,
        [FILES_WRITE] = LFS_O_WRONLY | LFS_O_CREAT | LFS_O_TRUNC,
        [FILES_APPEND] = LFS_O_WRONLY | LFS_O_CREAT | LFS_O_APPEND,
        [FILES_UPDATE] = LFS_O_RDWR | LFS_O_CREAT,
    };
    memset(handle, 0, sizeof *handle);
    handle->config.buffer = handle->buffer;
    handle->mode = (uint8_t)mode;
    files_volume_call_t call = {
        .path = path, .file = &handle->file, .config = &handle->config, .flags = flags[mode]};
    err_t error = call_volume(mode != FILES_READ, do_open, &call, NULL);
    if (error != ERR_OK) {
        return error;
    }
    handle->open = true;
    handle->generation = files_volume_generation();
    if (mode == FILES_READ && is_opened(&handle->file, false)) {
        handle->open = false;
        files_volume_read(do_close, &call, NULL);
        return err_raise(ERR_FILE_IN_USE, "%s", path);
    }
    return ERR_OK;
}

err_t files_open(const char *path, files_mode_t mode, int *number) {
    files_path_t place;
    err_t error = files_path_resolve(path, &place);
    if (error == ERR_OK && mode != FILES_READ) {
        error = files_names_check_unused(place.text);
    }
    if (error != ERR_OK) {
        return error;
    }
    handle_t *handle = free_handle(number);
    return handle != NULL ? open_handle(handle, place.text, mode)
                          : err_raise(ERR_FILES_TOO_MANY, NULL);
}

// ---- Reading and writing ------------------------------------------------------------------------

// The handle, if it is open and good for what is wanted.
static handle_t *use(int number, bool writes, err_t *error) {
    handle_t *handle = &files.handles[number];
    *error = ERR_OK;
    if (is_lost(handle)) {
        *error = err_raise(ERR_FILES_DAMAGED, NULL);
    } else if (writes ? handle->mode == FILES_READ
                      : handle->mode == FILES_WRITE || handle->mode == FILES_APPEND) {
        *error = err_raise(ERR_FILE_MODE, NULL);
    }
    return handle;
}

static bool has_unwritten(const handle_t *handle) {
    return (handle->file.flags & LFS_F_WRITING) != 0 && (handle->file.flags & LFS_F_INLINE) == 0;
}

// True if littlefs would take these bytes without touching the flash: a small file lives in its
// buffer, a larger one writes it out when it is full.
static bool fits_buffer(const handle_t *handle, size_t size) {
    const lfs_file_t *file = &handle->file;
    if (file->flags & LFS_F_INLINE) {
        lfs_off_t start = handle->mode == FILES_APPEND ? file->ctz.size : file->pos;
        return size <= FILES_BUFFER && start + size <= FILES_BUFFER;
    }
    return has_unwritten(handle) && file->off < HAL_STORAGE_SECTOR &&
           size < FILES_BUFFER - file->off % FILES_BUFFER;
}

err_t files_read(int number, void *bytes, size_t size, size_t *got) {
    err_t error;
    handle_t *handle = use(number, false, &error);
    *got = 0;
    if (error != ERR_OK) {
        return error;
    }
    files_volume_call_t call = {.file = &handle->file, .bytes = bytes, .size = (lfs_size_t)size};
    lfs_ssize_t result;
    error = call_volume(has_unwritten(handle), do_read, &call, &result);
    *got = error == ERR_OK ? (size_t)result : 0;
    return error;
}

err_t files_write(int number, const void *bytes, size_t size) {
    err_t error;
    handle_t *handle = use(number, true, &error);
    if (error != ERR_OK) {
        return error;
    }
    files_volume_call_t call = {.file = &handle->file, .source = bytes, .size = (lfs_size_t)size};
    return call_volume(!fits_buffer(handle, size), do_write, &call, NULL);
}

err_t files_flush(int number) {
    err_t error;
    handle_t *handle = use(number, true, &error);
    if (error != ERR_OK) {
        return error;
    }
    files_volume_call_t call = {.file = &handle->file};
    return files_volume_write(do_sync, &call, NULL);
}

err_t files_seek(int number, uint32_t position) {
    handle_t *handle = &files.handles[number];
    if (is_lost(handle)) {
        return err_raise(ERR_FILES_DAMAGED, NULL);
    }
    if (position > files_size(number)) {
        return err_raise(ERR_FILE_POSITION, NULL);
    }
    files_volume_call_t call = {.file = &handle->file, .size = position};
    return call_volume(has_unwritten(handle), do_seek, &call, NULL);
}

uint32_t files_size(int number) {
    const lfs_file_t *file = &files.handles[number].file;
    bool longer = (file->flags & LFS_F_WRITING) != 0 && file->pos > file->ctz.size;
    return longer ? file->pos : file->ctz.size;
}

uint32_t files_position(int number) {
    return files.handles[number].file.pos;
}

// ---- Closing ------------------------------------------------------------------------------------

static err_t close_now(handle_t *handle) {
    bool writes = handle->mode != FILES_READ;
    files_volume_call_t call = {.file = &handle->file};
    handle->open = false;
    return is_lost(handle) ? ERR_OK : call_volume(writes, do_close, &call, NULL);
}

err_t files_close(int number) {
    handle_t *handle = &files.handles[number];
    if (handle->mode != FILES_READ && !hal_storage_is_writable()) {
        files.closing += !handle->closing;
        handle->closing = true;
        return ERR_OK;
    }
    return close_now(handle);
}

// littlefs does not store a file that has met an error.
void files_abandon(int number) {
    handle_t *handle = &files.handles[number];
    files_volume_call_t call = {.file = &handle->file};
    handle->open = false;
    handle->file.flags |= LFS_F_ERRED;
    if (!is_lost(handle)) {
        files_volume_read(do_close, &call, NULL);
    }
}

bool files_background_waits(void) {
    return files.closing != 0;
}

err_t files_background(void) {
    if (files.closing == 0 || !hal_storage_is_writable()) {
        return ERR_OK;
    }
    err_t error = ERR_OK;
    files.closing = 0;
    for (size_t i = 0; i < FILES_OPEN_MAX; i++) {
        if (files.handles[i].open && files.handles[i].closing) {
            err_t now = close_now(&files.handles[i]);
            error = now != ERR_OK ? now : error;
        }
    }
    return error;
}
