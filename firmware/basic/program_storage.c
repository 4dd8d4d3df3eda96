// Each place: a page with a header, then the text. The header is written last; the place with the
// higher sequence number and a correct checksum counts. Context: main loop.
#include "program_storage.h"

#include <string.h>

#define MAGIC 0x50424D53u // "SMBP"
#define PLACES 2u

typedef struct {
    uint32_t magic;
    uint32_t sequence;
    uint32_t length;
    uint32_t text_crc;
    uint32_t header_crc; // of the fields above
} header_t;

static uint32_t header_crc(const header_t *header) {
    return crc_add(0, header, offsetof(header_t, header_crc));
}

// ---- Reading ------------------------------------------------------------------------------------

typedef enum { PLACE_EMPTY, PLACE_DAMAGED, PLACE_GOOD } place_state_t;

static const char *text_at(unsigned place) {
    return hal_storage_map(place * PROGRAM_STORAGE_PLACE + HAL_STORAGE_PAGE);
}

static place_state_t read_place(unsigned place, header_t *header) {
    hal_storage_read(place * PROGRAM_STORAGE_PLACE, header, sizeof *header);
    if (header->magic == UINT32_MAX) {
        return PLACE_EMPTY;
    }
    bool good = header->magic == MAGIC && header->header_crc == header_crc(header) &&
                header->length <= PROGRAM_STORAGE_MAX &&
                crc_add(0, text_at(place), header->length) == header->text_crc;
    return good ? PLACE_GOOD : PLACE_DAMAGED;
}

static bool is_newer(const header_t *a, const header_t *b) {
    return (int32_t)(a->sequence - b->sequence) > 0;
}

// The place that counts, or PLACES if none does. `damaged`: the other one may have been meant to.
static unsigned newest(header_t *best, bool *damaged) {
    header_t headers[PLACES];
    place_state_t states[PLACES];
    unsigned found = PLACES;
    for (unsigned place = 0; place < PLACES; place++) {
        states[place] = read_place(place, &headers[place]);
        if (states[place] == PLACE_GOOD && (found == PLACES || is_newer(&headers[place], best))) {
            found = place;
            *best = headers[place];
        }
    }
    *damaged = false;
    for (unsigned place = 0; place < PLACES; place++) {
        const header_t *header = &headers[place];
        bool older =
            found < PLACES && header->header_crc == header_crc(header) && !is_newer(header, best);
        *damaged |= states[place] == PLACE_DAMAGED && !older;
    }
    return found;
}

const char *program_storage_text(size_t *length, bool *damaged) {
    header_t header;
    unsigned place = newest(&header, damaged);
    *length = place < PLACES ? header.length : 0;
    return place < PLACES ? text_at(place) : "";
}

// ---- Writing ------------------------------------------------------------------------------------

void program_storage_begin(program_storage_t *writer) {
    header_t old = {.sequence = 0};
    bool damaged;
    unsigned place = newest(&old, &damaged) == 0 ? 1 : 0;
    memset(writer, 0, sizeof *writer);
    writer->base = place * PROGRAM_STORAGE_PLACE;
    writer->sequence = old.sequence + 1;
}

static err_t failure(void) {
    return err_raise(hal_storage_is_writable() ? ERR_STORAGE_FAILED : ERR_STORAGE_BUSY, NULL);
}

// The page at hand goes to the flash; the sector is erased when its first page comes.
static err_t write_page(program_storage_t *writer) {
    uint32_t place = writer->base + HAL_STORAGE_PAGE + writer->written;
    bool erases = place % HAL_STORAGE_SECTOR == 0;
    bool first = writer->written == 0; // the header is in the same sector
    if (first && !hal_storage_erase(writer->base)) {
        return failure();
    }
    if (erases && !hal_storage_erase(place)) {
        return failure();
    }
    memset(writer->page + writer->used, 0xFF, HAL_STORAGE_PAGE - writer->used);
    if (!hal_storage_program(place, writer->page)) {
        return failure();
    }
    writer->crc = crc_add(writer->crc, writer->page, writer->used);
    writer->written += writer->used;
    writer->used = 0;
    return ERR_OK;
}

static err_t add_byte(program_storage_t *writer, char c) {
    if (writer->written + writer->used >= PROGRAM_STORAGE_MAX) {
        return err_raise(ERR_PROGRAM_TOO_LONG, NULL);
    }
    writer->page[writer->used++] = (uint8_t)c;
    return writer->used == HAL_STORAGE_PAGE ? write_page(writer) : ERR_OK;
}

err_t program_storage_add(program_storage_t *writer, const char *text, size_t size) {
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        bool second_half = c == '\n' && writer->after_return;
        writer->after_return = c == '\r';
        err_t error = second_half ? ERR_OK : add_byte(writer, c == '\r' ? '\n' : c);
        if (error != ERR_OK) {
            return error;
        }
    }
    return ERR_OK;
}

static err_t write_header(const program_storage_t *writer) {
    uint8_t page[HAL_STORAGE_PAGE];
    header_t header = {MAGIC, writer->sequence, writer->written, writer->crc, 0};
    header.header_crc = header_crc(&header);
    memset(page, 0xFF, sizeof page);
    memcpy(page, &header, sizeof header);
    return hal_storage_program(writer->base, page) ? ERR_OK : failure();
}

err_t program_storage_commit(program_storage_t *writer) {
    err_t error = writer->used != 0 || writer->written == 0 ? write_page(writer) : ERR_OK;
    const char *text = hal_storage_map(writer->base + HAL_STORAGE_PAGE);
    if (error == ERR_OK && crc_add(0, text, writer->written) != writer->crc) {
        error = err_raise(ERR_STORAGE_FAILED, NULL);
    }
    return error == ERR_OK ? write_header(writer) : error;
}
