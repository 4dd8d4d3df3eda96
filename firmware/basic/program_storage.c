// The program in flash: a header page, then the text. The header is written last; the place with the
// higher sequence number and a correct checksum counts. Context: main loop.
#include "program_storage.h"

#include <string.h>

#include "hal/hal.h"

#define MAGIC 0x50424D53u // "SMBP"
#define PLACES 2u
#define PLACE_SIZE (HAL_STORAGE_SIZE / PLACES)

typedef struct {
    uint32_t magic;
    uint32_t sequence;
    uint32_t length;
    uint32_t text_crc;
    uint32_t header_crc; // of the fields above
} header_t;

// CRC-32 as of IEEE 802.3, bit by bit: programs are small and this is rare.
static uint32_t crc32(uint32_t crc, const void *bytes, size_t size) {
    const uint8_t *p = bytes;
    crc = ~crc;
    for (size_t i = 0; i < size; i++) {
        crc ^= p[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
        }
    }
    return ~crc;
}

static uint32_t header_crc(const header_t *header) {
    return crc32(0, header, offsetof(header_t, header_crc));
}

typedef enum { PLACE_EMPTY, PLACE_DAMAGED, PLACE_GOOD } place_state_t;

static place_state_t read_header(unsigned place, header_t *header) {
    hal_storage_read(place * PLACE_SIZE, header, sizeof *header);
    if (header->magic == UINT32_MAX) {
        return PLACE_EMPTY;
    }
    bool good = header->magic == MAGIC && header->header_crc == header_crc(header) &&
                header->length <= PROGRAM_STORAGE_MAX;
    return good ? PLACE_GOOD : PLACE_DAMAGED;
}

static uint32_t stored_crc(unsigned place, uint32_t length) {
    uint32_t crc = 0;
    uint8_t page[HAL_STORAGE_PAGE];
    for (uint32_t offset = 0; offset < length; offset += sizeof page) {
        uint32_t size = length - offset < sizeof page ? length - offset : sizeof page;
        hal_storage_read(place * PLACE_SIZE + HAL_STORAGE_PAGE + offset, page, size);
        crc = crc32(crc, page, size);
    }
    return crc;
}

// The place to load from, or PLACES. `damaged` becomes true if a newer one had to be passed over.
static unsigned newest(header_t *best, bool *damaged) {
    unsigned found = PLACES;
    *damaged = false;
    for (unsigned place = 0; place < PLACES; place++) {
        header_t header;
        place_state_t state = read_header(place, &header);
        if (state == PLACE_GOOD && stored_crc(place, header.length) != header.text_crc) {
            state = PLACE_DAMAGED;
        }
        *damaged |= state == PLACE_DAMAGED;
        if (state == PLACE_GOOD && (found == PLACES || header.sequence > best->sequence)) {
            found = place;
            *best = header;
        }
    }
    return found;
}

static err_t write_text(uint32_t base, const char *text, size_t length) {
    for (size_t offset = 0; offset < length; offset += HAL_STORAGE_PAGE) {
        uint8_t page[HAL_STORAGE_PAGE];
        size_t size = length - offset < sizeof page ? length - offset : sizeof page;
        memset(page, 0xFF, sizeof page);
        memcpy(page, text + offset, size);
        if (!hal_storage_program((uint32_t)(base + HAL_STORAGE_PAGE + offset), page)) {
            return err_raise(ERR_STORAGE_BUSY, "%s", "");
        }
    }
    return ERR_OK;
}

static err_t write_header(uint32_t base, const header_t *header) {
    uint8_t page[HAL_STORAGE_PAGE];
    memset(page, 0xFF, sizeof page);
    memcpy(page, header, sizeof *header);
    if (!hal_storage_program(base, page)) {
        return err_raise(ERR_STORAGE_BUSY, "%s", "");
    }
    return ERR_OK;
}

err_t program_storage_save(const char *text, size_t length) {
    if (length > PROGRAM_STORAGE_MAX) {
        return err_raise(ERR_PROGRAM_TOO_LONG, "%s", "");
    }
    header_t old = {.sequence = 0};
    bool damaged;
    unsigned place = newest(&old, &damaged) == 0 ? 1 : 0;
    uint32_t base = place * PLACE_SIZE;
    for (uint32_t offset = 0; offset < HAL_STORAGE_PAGE + length; offset += HAL_STORAGE_SECTOR) {
        if (!hal_storage_erase(base + offset)) {
            return err_raise(ERR_STORAGE_BUSY, "%s", "");
        }
    }
    err_t error = write_text(base, text, length);
    if (error != ERR_OK) {
        return error;
    }
    header_t header = {MAGIC, old.sequence + 1, (uint32_t)length, crc32(0, text, length), 0};
    header.header_crc = header_crc(&header);
    error = write_header(base, &header);
    if (error == ERR_OK && stored_crc(place, header.length) != header.text_crc) {
        return err_raise(ERR_STORAGE_FAILED, "%s", "");
    }
    return error;
}

err_t program_storage_load(char *text, size_t size, size_t *length) {
    header_t header;
    bool damaged;
    unsigned place = newest(&header, &damaged);
    *length = 0;
    if (place < PLACES && header.length <= size) {
        hal_storage_read(place * PLACE_SIZE + HAL_STORAGE_PAGE, text, header.length);
        *length = header.length;
    }
    return damaged ? err_raise(ERR_STORAGE_CORRUPT, "%s", "") : ERR_OK;
}
