// Files as a kind of channel. Context: main loop.
#include "channel_files.h"

#include <string.h>

#include "files/files.h"
#include "memory.h"

static err_t open(basic_text_t text, basic_device_mode_t mode, int *handle) {
    static const files_mode_t modes[] = {
        [BASIC_DEVICE_INPUT] = FILES_READ,
        [BASIC_DEVICE_OUTPUT] = FILES_WRITE,
        [BASIC_DEVICE_APPEND] = FILES_APPEND,
        [BASIC_DEVICE_RANDOM] = FILES_UPDATE,
    };
    if (mode == BASIC_DEVICE_UNSAID) {
        return err_raise(ERR_ARGUMENTS_MISSING, "FOR INPUT, OUTPUT, APPEND or RANDOM");
    }
    char *path = memory_text(text.length + 1);
    memcpy(path, text.text, text.length);
    path[text.length] = '\0';
    if (strlen(path) != text.length) {
        return err_raise(ERR_FILE_BAD_NAME, "%s", path);
    }
    err_t error = files_open(path, modes[mode], handle);
    if (error == ERR_OK && mode == BASIC_DEVICE_RANDOM) {
        error = files_seek(*handle, files_size(*handle));
    }
    return error;
}

static err_t write(int handle, const void *bytes, size_t size, size_t *took) {
    err_t error = files_write(handle, bytes, size);
    *took = error == ERR_OK ? size : 0;
    return error;
}

static bool at_end(int handle) {
    return files_position(handle) >= files_size(handle);
}

static uint32_t position(int handle) {
    return files_position(handle) + 1;
}

static err_t seek(int handle, uint32_t place) {
    return files_seek(handle, place - 1);
}

const basic_device_t channel_files = {
    .name = "A",
    .open = open,
    .close = files_close,
    .write = write,
    .read = files_read,
    .at_end = at_end,
    .length = files_size,
    .position = position,
    .seek = seek,
    .flush = files_flush,
};
