// A file written as a whole. Context: main loop.
#include "file_output.h"

#include <string.h>

#include "files/files.h"

static struct {
    const char *path;
    int handle;
} output;

err_t file_output_start(const char *path) {
    output.path = path;
    return files_begin_replacement(path, &output.handle);
}

err_t file_output_write(const void *bytes, size_t size) {
    return files_write(output.handle, bytes, size);
}

err_t file_output_end(err_t error) {
    if (error == ERR_OK) {
        return files_commit_replacement(output.handle, output.path);
    }
    char message[ERR_MESSAGE_SIZE];
    strcpy(message, err_message());
    files_abandon(output.handle);
    return err_raise(ERR_ARGUMENT, "%s", message);
}
