// The flash file system A:, power-loss safe (littlefs). Files are named "A:/folder/name",
// "/folder/name" or, from the current folder, "name"; upper and lower case differ. The face of
// firmware/files.
//
// What a file holds changes as a whole when it is closed or flushed: after a power cut it is what
// it was before. Nothing is written while motion is under way: such calls fail with
// ERR_STORAGE_BUSY, have done nothing, and may be made again. All functions raise their error.
// Context: main loop.
#ifndef FILES_H
#define FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

#define FILES_OPEN_MAX 10
#define FILES_NAME_MAX 63
#define FILES_PATH_MAX 127 // of a whole path without the drive

// Looks at what is in the flash. The file system is made when first something is written.
// ERR_FILES_DAMAGED: there is something that is no file system any more; the next write makes a new
// one over it.
err_t files_start(void);

// Deletes everything.
err_t files_format(void);

// Where to call now and then when something may be left to do; costs nothing if not. Returns the
// error of a file that was closed while motion was under way and cannot be stored.
err_t files_background(void);

// There is something for files_background() to do.
bool files_background_waits(void);

// ---- Open files ---------------------------------------------------------------------------------

typedef enum {
    FILES_READ,   // from the start
    FILES_WRITE,  // a new file, or a new content
    FILES_APPEND, // at the end, a new file if there is none
    FILES_UPDATE  // reads and writes anywhere; a new file if there is none
} files_mode_t;

// A file that is being written is open only once. Errors: not found, is a folder, bad name, in use,
// too many are open, motion is under way (unless FILES_READ).
err_t files_open(const char *path, files_mode_t mode, int *handle);

// The handle is free, whatever comes of it. Errors: disk full. While motion is under way a file
// that was written is closed as soon as it has ended.
err_t files_close(int handle);

// Closes it without what was written since it was opened or flushed.
void files_abandon(int handle);

// *got < size: the end of the file was met.
err_t files_read(int handle, void *bytes, size_t size, size_t *got);

// While motion is under way, takes what fits in the file's buffer (up to FILES_BUFFER bytes since
// the last that went to the flash), and refuses the rest as a whole. If the disk becomes full what
// fitted stays.
#define FILES_BUFFER 128
err_t files_write(int handle, const void *bytes, size_t size);

// Makes what was written so far the file's content.
err_t files_flush(int handle);

// Error: beyond the end.
err_t files_seek(int handle, uint32_t position);
uint32_t files_size(int handle);
uint32_t files_position(int handle);

// Makes this the content of the file, a new one if need be: after a power cut there is the old or
// the new content, and no new file without its content.
err_t files_replace(const char *path, const void *bytes, size_t size);

// The same in steps: a content on its way, to be written as any file, one at a time; then it
// becomes that of the file, or files_abandon() gives it up. The handle is free whatever comes of
// the commit.
err_t files_begin_replacement(const char *path, int *handle);
err_t files_commit_replacement(int handle, const char *path);

// ---- Names and folders --------------------------------------------------------------------------

typedef struct {
    char name[FILES_NAME_MAX + 1];
    uint32_t size; // bytes; 0 for a folder
    bool is_folder;
} files_entry_t;

// Errors: not found, in use, is a folder.
err_t files_remove(const char *path);

// A file or a folder; `to` must not be there yet.
err_t files_rename(const char *from, const char *to);

err_t files_make_folder(const char *path);
err_t files_remove_folder(const char *path); // error: not empty

// The current folder, "/" at start.
err_t files_change_folder(const char *path);
const char *files_folder(void);

// The entries of a folder by the codes of their characters, but "name10" comes before "name1". One
// list at a time: a further start ends it. Files may be deleted meanwhile; new ones may be missing.
err_t files_list_start(const char *folder);
bool files_list_next(files_entry_t *entry);

// Tells one list from the next.
unsigned files_list_number(void);

err_t files_info(const char *path, files_entry_t *entry);

// Bytes in all, and in use, in blocks of 4 KB.
err_t files_space(uint32_t *total, uint32_t *used);

#endif
