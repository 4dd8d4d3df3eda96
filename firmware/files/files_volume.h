// The part of the flash that holds the file system, and calls of littlefs from which a damaged
// image cannot keep us. Inside files/ only. Context: main loop.
#ifndef FILES_VOLUME_H
#define FILES_VOLUME_H

#include "files/files.h"
#include "hal/hal.h"
#include "lfs.h"

#define FILES_VOLUME_START (256u * 1024u) // behind the two places of the program
#define FILES_VOLUME_BLOCKS ((HAL_STORAGE_SIZE - FILES_VOLUME_START) / HAL_STORAGE_SECTOR)

// The arguments of a call of littlefs; those it has no use for are not set.
typedef struct {
    const char *path, *to;
    lfs_file_t *file;
    const struct lfs_file_config *config; // with `flags`, to open a file
    int flags;
    lfs_dir_t *folder;
    struct lfs_info *info;
    void *bytes;
    const void *source;
    lfs_size_t size; // or a position
} files_volume_call_t;

typedef lfs_ssize_t (*files_volume_work_t)(lfs_t *lfs, const files_volume_call_t *call);

// Makes the call. At least 0, or the error it raised. Not found, if there is no file system yet.
// `writes`: makes one then; ERR_STORAGE_BUSY if motion is under way.
err_t files_volume_read(files_volume_work_t work, const files_volume_call_t *call,
                        lfs_ssize_t *result);
err_t files_volume_write(files_volume_work_t work, const files_volume_call_t *call,
                         lfs_ssize_t *result);

// Looks for a file system. False: what is there is none, and not nothing either.
bool files_volume_start(void);

// Makes a new one.
err_t files_volume_format(void);

// Changes whenever all open files are lost: the volume was damaged and had to be left.
unsigned files_volume_generation(void);

#endif
