// A file written as a whole. Context: main loop.
#include "file_output.h"

#include <string.h>

#include "files/files.h"

static struct {
    const char *path;
    int handle;
    bool is_new;
} output;

err_t file_output_start(const char *path) {
    files_entry_t entry;
    output.path = path;
    output.is_new = files_info(path, &entry) != ERR_OK;
    return files_open(path, FILES_WRITE, &output.handle);
}

err_t file_output_write(const void *bytes, size_t size) {
    return files_write(output.handle, bytes, size);
}

err_t file_output_end(err_t error) {
    if (error == ERR_OK) {
        return files_close(output.handle);
    }
    char message[ERR_MESSAGE_SIZE];
    strcpy(message, err_message());
    files_abandon(output.handle);
    if (output.is_new) {
        files_remove(output.path);
    }
    return err_raise(ERR_ARGUMENT, "%s", message);
}
