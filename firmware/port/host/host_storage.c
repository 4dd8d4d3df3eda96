// Simulates NOR flash: erasing sets, programming only clears bits; and a power cut in the middle of
// it. Context: main.
#include "host_storage.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/hal.h"
#include "host_system.h"

#define OLD_IMAGE_SIZE (256 * 1024) // of firmware before there were files

static struct {
    uint8_t bytes[HAL_STORAGE_SIZE];
    bool ready; // they hold something: before, they are not erased yet
    int file;
    const char *path;
    unsigned writes_left; // until the power is cut; 0: never
    host_storage_cut_t cut;
} storage = {.file = -1};

static uint8_t *contents(void) {
    if (!storage.ready) {
        storage.ready = true;
        memset(storage.bytes, 0xFF, sizeof storage.bytes);
    }
    return storage.bytes;
}

static bool is_range(uint32_t offset, size_t size) {
    return offset <= HAL_STORAGE_SIZE && size <= HAL_STORAGE_SIZE - offset;
}

// Brings the file up to date with memory.
static void save(uint32_t offset, size_t size) {
    if (storage.file < 0) {
        return;
    }
    if (pwrite(storage.file, contents() + offset, size, (off_t)offset) != (ssize_t)size) {
        host_system_fail("%s: %s", storage.path, strerror(errno));
    }
}

static void load(size_t size) {
    ssize_t got = pread(storage.file, contents(), size, 0);
    if (got != (ssize_t)size) {
        host_system_fail("%s: %s", storage.path, got < 0 ? strerror(errno) : "ended too early");
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
        save(0, HAL_STORAGE_SIZE);
    } else if (status.st_size == OLD_IMAGE_SIZE) { // its programs lie where they lie now
        load(OLD_IMAGE_SIZE);
        save(0, HAL_STORAGE_SIZE);
    } else if (status.st_size == (off_t)HAL_STORAGE_SIZE) {
        load(HAL_STORAGE_SIZE);
    } else {
        host_system_fail("%s: a flash image has %u bytes, this file has %lld", path,
                         HAL_STORAGE_SIZE, (long long)status.st_size);
    }
}

void host_storage_cut(unsigned writes, host_storage_cut_t cut) {
    storage.writes_left = writes;
    storage.cut = cut;
}

// The write at hand is the one in which the power goes. What a torn one leaves behind is different
// in each byte, and the same in each run.
static bool is_cut(void) {
    return storage.writes_left != 0 && --storage.writes_left == 0;
}

static uint8_t half_of(size_t place) {
    return (uint8_t)(place * 2654435761u >> 13);
}

static _Noreturn void cut_power(uint32_t offset, size_t size) {
    save(offset, size);
    _exit(HOST_STORAGE_EXIT_CUT); // nothing else happens any more, no output either
}

void hal_storage_read(uint32_t offset, void *bytes, size_t size) {
    if (!is_range(offset, size)) {
        host_system_fail("the firmware read beyond its storage: %zu bytes at %u", size,
                         (unsigned)offset);
    }
    memcpy(bytes, contents() + offset, size);
}

const void *hal_storage_map(uint32_t offset) {
    return contents() + offset;
}

bool hal_storage_is_writable(void) {
    bool writable = hal_on_storage_begin();
    if (writable) {
        hal_on_storage_end();
    }
    return writable;
}

bool hal_storage_erase(uint32_t offset) {
    if (offset % HAL_STORAGE_SECTOR != 0 || !is_range(offset, HAL_STORAGE_SECTOR) ||
        !hal_on_storage_begin()) {
        return false;
    }
    uint8_t *sector = contents() + offset;
    bool cut = is_cut();
    for (size_t i = 0; i < HAL_STORAGE_SECTOR; i++) {
        bool spared = cut && storage.cut == HOST_STORAGE_CUT_BEFORE;
        uint8_t erased = cut && storage.cut == HOST_STORAGE_CUT_TORN ? half_of(i) : 0xFF;
        sector[i] |= spared ? 0 : erased;
    }
    if (cut) {
        cut_power(offset, HAL_STORAGE_SECTOR);
    }
    save(offset, HAL_STORAGE_SECTOR);
    hal_on_storage_end();
    return true;
}

bool hal_storage_program(uint32_t offset, const void *page) {
    if (offset % HAL_STORAGE_PAGE != 0 || !is_range(offset, HAL_STORAGE_PAGE) ||
        !hal_on_storage_begin()) {
        return false;
    }
    uint8_t *to = contents() + offset;
    const uint8_t *from = page;
    bool cut = is_cut();
    for (size_t i = 0; i < HAL_STORAGE_PAGE; i++) {
        bool spared = cut && storage.cut == HOST_STORAGE_CUT_BEFORE;
        uint8_t kept = cut && storage.cut == HOST_STORAGE_CUT_TORN ? half_of(i) : 0;
        to[i] &= spared ? 0xFF : from[i] | kept;
    }
    if (cut) {
        cut_power(offset, HAL_STORAGE_PAGE);
    }
    save(offset, HAL_STORAGE_PAGE);
    hal_on_storage_end();
    return true;
}
