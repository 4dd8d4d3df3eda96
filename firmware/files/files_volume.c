// Mounting, and littlefs's way to the flash. Context: main loop.
#include "files_volume.h"

#include <setjmp.h>
#include <string.h>

#include "files_assert.h"
#include "hal/hal.h"

#define LOOKAHEAD_BYTES 32
#define WEAR_CYCLES 500
// Reads of the flash that one call may take. The longest on a full volume needs some ten thousand;
// in a damaged one the way can be a circle.
#define READS_MAX 400000u

static_assert(FILES_VOLUME_BLOCKS == 8 * LOOKAHEAD_BYTES, "one look finds all free blocks");

typedef enum { VOLUME_UNKNOWN, VOLUME_NONE, VOLUME_MOUNTED } volume_state_t;

static struct {
    lfs_t lfs;
    volume_state_t state;
    unsigned generation;
    uint32_t reads;
    jmp_buf *escape;
    uint8_t read_buffer[FILES_BUFFER];
    uint8_t write_buffer[FILES_BUFFER];
    uint32_t lookahead[LOOKAHEAD_BYTES / 4];
} volume;

// ---- The flash ----------------------------------------------------------------------------------

static uint32_t place_of(lfs_block_t block, lfs_off_t offset) {
    return FILES_VOLUME_START + block * HAL_STORAGE_SECTOR + offset;
}

static int read_flash(const struct lfs_config *config, lfs_block_t block, lfs_off_t offset,
                      void *bytes, lfs_size_t size) {
    (void)config;
    if (++volume.reads > READS_MAX) {
        files_give_up();
    }
    hal_storage_read(place_of(block, offset), bytes, size);
    return 0;
}

// A part of a page: the rest of it stays as it is.
static int write_part(uint32_t place, const uint8_t *bytes, lfs_size_t size) {
    uint8_t page[HAL_STORAGE_PAGE];
    uint32_t start = place % HAL_STORAGE_PAGE;
    memset(page, 0xFF, sizeof page);
    memcpy(page + start, bytes, size);
    return hal_storage_program(place - start, page) ? 0 : LFS_ERR_IO;
}

static int write_flash(const struct lfs_config *config, lfs_block_t block, lfs_off_t offset,
                       const void *bytes, lfs_size_t size) {
    (void)config;
    static_assert(HAL_STORAGE_PAGE % FILES_BUFFER == 0, "a buffer lies in one page");
    for (lfs_size_t done = 0; done < size; done += FILES_BUFFER) {
        int error =
            write_part(place_of(block, offset + done), (const uint8_t *)bytes + done, FILES_BUFFER);
        if (error != 0) {
            return error;
        }
    }
    return 0;
}

static int erase_flash(const struct lfs_config *config, lfs_block_t block) {
    (void)config;
    return hal_storage_erase(place_of(block, 0)) ? 0 : LFS_ERR_IO;
}

static int sync_flash(const struct lfs_config *config) {
    (void)config;
    return 0;
}

static const struct lfs_config config = {
    .read = read_flash,
    .prog = write_flash,
    .erase = erase_flash,
    .sync = sync_flash,
    .read_size = 16,
    .prog_size = FILES_BUFFER,
    .block_size = HAL_STORAGE_SECTOR,
    .block_count = FILES_VOLUME_BLOCKS,
    .block_cycles = WEAR_CYCLES,
    .cache_size = FILES_BUFFER,
    .lookahead_size = LOOKAHEAD_BYTES,
    .read_buffer = volume.read_buffer,
    .prog_buffer = volume.write_buffer,
    .lookahead_buffer = volume.lookahead,
};

// ---- Calls --------------------------------------------------------------------------------------

static err_t error_of(lfs_ssize_t error, const files_volume_call_t *call) {
    static const struct {
        int lfs;
        err_t code;
    } errors[] = {
        {LFS_ERR_NOENT, ERR_FILE_NOT_FOUND},      {LFS_ERR_EXIST, ERR_FILE_EXISTS},
        {LFS_ERR_NOTDIR, ERR_NOT_A_FOLDER},       {LFS_ERR_ISDIR, ERR_IS_A_FOLDER},
        {LFS_ERR_NOTEMPTY, ERR_FOLDER_IN_USE},    {LFS_ERR_NOSPC, ERR_DISK_FULL},
        {LFS_ERR_NAMETOOLONG, ERR_FILE_BAD_NAME}, {LFS_ERR_FBIG, ERR_DISK_FULL},
    };
    const char *name = error == LFS_ERR_EXIST && call->to != NULL ? call->to : call->path;
    for (size_t i = 0; i < COUNT_OF_ARRAY(errors); i++) {
        if (errors[i].lfs == error) {
            return err_raise(errors[i].code, "%s", name != NULL ? name : "");
        }
    }
    return err_raise(ERR_FILES_DAMAGED, NULL);
}

void files_give_up(void) {
    longjmp(*volume.escape, 1);
}

// What littlefs has in memory is worth nothing after it was left in the middle.
static void leave_volume(void) {
    volume.state = VOLUME_UNKNOWN;
    volume.generation++;
}

static lfs_ssize_t guarded(files_volume_work_t work, const files_volume_call_t *call) {
    jmp_buf here;
    volume.reads = 0;
    volume.escape = &here;
    if (setjmp(here) != 0) {
        leave_volume();
        return LFS_ERR_CORRUPT;
    }
    return work(&volume.lfs, call);
}

static lfs_ssize_t mount(lfs_t *lfs, const files_volume_call_t *call) {
    (void)call;
    return lfs_mount(lfs, &config);
}

// Completes what a power cut has left half done. littlefs would do so at the next write; but until
// then, with a move to another folder under way, it does not find the file behind the one that was
// moved.
static lfs_ssize_t make_consistent(lfs_t *lfs, const files_volume_call_t *call) {
    (void)call;
    return lfs_fs_mkconsistent(lfs);
}

static lfs_ssize_t format(lfs_t *lfs, const files_volume_call_t *call) {
    (void)call;
    return lfs_format(lfs, &config);
}

// Both blocks that a file system starts with are erased: there never was one.
static bool is_blank(void) {
    const uint8_t *bytes = hal_storage_map(FILES_VOLUME_START);
    for (size_t i = 0; i < 2 * HAL_STORAGE_SECTOR; i++) {
        if (bytes[i] != 0xFF) {
            return false;
        }
    }
    return true;
}

bool files_volume_start(void) {
    bool mounted = guarded(mount, NULL) == 0;
    if (mounted && hal_storage_is_writable() && guarded(make_consistent, NULL) != 0) {
        mounted = guarded(mount, NULL) == 0; // what can be read shall be read
    }
    volume.state = mounted ? VOLUME_MOUNTED : VOLUME_NONE;
    return mounted || is_blank();
}

err_t files_volume_format(void) {
    if (!hal_storage_is_writable()) {
        return err_raise(ERR_STORAGE_BUSY, NULL);
    }
    leave_volume();
    lfs_ssize_t error = guarded(format, NULL);
    if (error == 0) {
        error = guarded(mount, NULL);
    }
    if (error != 0) {
        return err_raise(ERR_STORAGE_FAILED, NULL);
    }
    volume.state = VOLUME_MOUNTED;
    return ERR_OK;
}

err_t files_volume_read(files_volume_work_t work, const files_volume_call_t *call,
                        lfs_ssize_t *result) {
    if (volume.state == VOLUME_UNKNOWN) {
        files_volume_start();
    }
    lfs_ssize_t got = volume.state == VOLUME_MOUNTED ? guarded(work, call) : LFS_ERR_NOENT;
    if (result != NULL) {
        *result = got;
    }
    return got >= 0 ? ERR_OK : error_of(got, call);
}

err_t files_volume_write(files_volume_work_t work, const files_volume_call_t *call,
                         lfs_ssize_t *result) {
    if (!hal_storage_is_writable()) {
        return err_raise(ERR_STORAGE_BUSY, NULL);
    }
    if (volume.state == VOLUME_UNKNOWN) {
        files_volume_start();
    }
    if (volume.state == VOLUME_NONE) {
        err_t error = files_volume_format();
        if (error != ERR_OK) {
            return error;
        }
    }
    return files_volume_read(work, call, result);
}

unsigned files_volume_generation(void) {
    return volume.generation;
}
