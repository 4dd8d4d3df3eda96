// Simulates NOR flash: erasing sets, programming only clears bits. Context: main.
#include "host_storage.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/hal.h"
#include "host_system.h"

// Kept inverted, so that fresh static memory is erased flash.
static struct {
    uint8_t inverted[HAL_STORAGE_SIZE];
    int file;
    const char *path;
} storage = {.file = -1};

static bool is_range(uint32_t offset, size_t size) {
    return offset <= HAL_STORAGE_SIZE && size <= HAL_STORAGE_SIZE - offset;
}

// Brings the file up to date with memory.
static void save(uint32_t offset, size_t size) {
    if (storage.file < 0) {
        return;
    }
    uint8_t bytes[HAL_STORAGE_SECTOR];
    hal_storage_read(offset, bytes, size);
    if (pwrite(storage.file, bytes, size, (off_t)offset) != (ssize_t)size) {
        host_system_fail("%s: %s", storage.path, strerror(errno));
    }
}

static void create(void) {
    for (uint32_t offset = 0; offset < HAL_STORAGE_SIZE; offset += HAL_STORAGE_SECTOR) {
        save(offset, HAL_STORAGE_SECTOR);
    }
}

static void load(void) {
    ssize_t got = pread(storage.file, storage.inverted, HAL_STORAGE_SIZE, 0);
    if (got != (ssize_t)HAL_STORAGE_SIZE) {
        host_system_fail("%s: %s", storage.path, got < 0 ? strerror(errno) : "ended too early");
    }
    for (size_t i = 0; i < HAL_STORAGE_SIZE; i++) {
        storage.inverted[i] = (uint8_t)~storage.inverted[i];
    }
}

void host_storage_open(const char *path) {
    storage.path = path;
    storage.file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (storage.file < 0) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    if (flock(storage.file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        host_system_fail("%s: in use by another stepmite", path);
    }
    struct stat status;
    if (fstat(storage.file, &status) != 0) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        host_system_fail("%s: not a regular file", path);
    }
    if (status.st_size == 0) {
        create();
    } else if (status.st_size == (off_t)HAL_STORAGE_SIZE) {
        load();
    } else {
        host_system_fail("%s: a flash image has %u bytes, this file has %lld", path,
                         HAL_STORAGE_SIZE, (long long)status.st_size);
    }
}

void hal_storage_read(uint32_t offset, void *bytes, size_t size) {
    if (!is_range(offset, size)) {
        host_system_fail("the firmware read beyond its storage: %zu bytes at %u", size,
                         (unsigned)offset);
    }
    uint8_t *to = bytes;
    for (size_t i = 0; i < size; i++) {
        to[i] = (uint8_t)~storage.inverted[offset + i];
    }
}

bool hal_storage_erase(uint32_t offset) {
    if (hal_tick_running() || offset % HAL_STORAGE_SECTOR != 0 ||
        !is_range(offset, HAL_STORAGE_SECTOR)) {
        return false;
    }
    memset(storage.inverted + offset, 0, HAL_STORAGE_SECTOR);
    save(offset, HAL_STORAGE_SECTOR);
    return true;
}

bool hal_storage_program(uint32_t offset, const void *page) {
    if (hal_tick_running() || offset % HAL_STORAGE_PAGE != 0 ||
        !is_range(offset, HAL_STORAGE_PAGE)) {
        return false;
    }
    const uint8_t *from = page;
    for (size_t i = 0; i < HAL_STORAGE_PAGE; i++) {
        storage.inverted[offset + i] |= (uint8_t)~from[i];
    }
    save(offset, HAL_STORAGE_PAGE);
    return true;
}
