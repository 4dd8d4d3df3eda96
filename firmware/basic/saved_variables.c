// The file: for each variable a record and its bytes, then a record of zeros with the checksum of
// all before it. Context: main loop.
#include "saved_variables.h"

#include <string.h>

#include "errors.h"
#include "files/files.h"
#include "memory.h"
#include "saved_record.h"

#define FILE_NAME "/.variables"
#define CHUNK 64u

static struct {
    int old, new; // handles; -1: not open
    uint32_t crc; // of what went to the new file
    const value_t *handles;
    unsigned count;
} saving;

static void check(err_t error) {
    if (error != ERR_OK) {
        errors_fail_raised();
    }
}

static void read_exactly(int file, void *bytes, size_t size) {
    size_t got;
    check(files_read(file, bytes, size, &got));
    if (got != size) {
        errors_fail(ERR_VARIABLES_DAMAGED);
    }
}

// The next record; false: the end, whose checksum is in `record->size`.
static bool read_record(int file, saved_record_t *record) {
    read_exactly(file, record, sizeof *record);
    if (record->check == 0) {
        return false;
    }
    if (record->check != SAVED_RECORD_CHECK || !saved_record_is_sound(record)) {
        errors_fail(ERR_VARIABLES_DAMAGED);
    }
    return true;
}

// Reads all of it, so that nothing of a damaged file is taken for a value.
static void check_file(int file) {
    saved_record_t record;
    uint8_t bytes[CHUNK];
    uint32_t crc = 0;
    while (read_record(file, &record)) {
        crc = crc_add(crc, &record, sizeof record);
        for (uint32_t left = record.size; left > 0;) {
            uint32_t part = left < CHUNK ? left : CHUNK;
            read_exactly(file, bytes, part);
            crc = crc_add(crc, bytes, part);
            left -= part;
        }
    }
    if (record.size != crc) {
        errors_fail(ERR_VARIABLES_DAMAGED);
    }
    check(files_seek(file, 0));
}

// True if something is saved; then `saving.old` is open and has been checked.
static bool open_old(void) {
    files_entry_t entry;
    if (files_info(FILE_NAME, &entry) == ERR_FILE_NOT_FOUND) {
        return false;
    }
    check(files_open(FILE_NAME, FILES_READ, &saving.old));
    check_file(saving.old);
    return true;
}

static void close_files(void) {
    if (saving.old >= 0) {
        files_close(saving.old);
    }
    if (saving.new >= 0) {
        files_abandon(saving.new);
    }
    saving.old = saving.new = -1;
}

// Does the work and leaves no file open.
static void with_files(void (*work)(void)) {
    saving.old = saving.new = -1;
    errors_outcome_t outcome = errors_try(work);
    char message[ERR_MESSAGE_SIZE];
    strcpy(message, err_message());
    close_files();
    if (outcome != ERRORS_NONE) {
        errors_fail_with(ERR_ARGUMENT, "%s", message);
    }
}

// ---- Saving -------------------------------------------------------------------------------------

static void write(const void *bytes, size_t size) {
    saving.crc = crc_add(saving.crc, bytes, size);
    check(files_write(saving.new, bytes, size));
}

static const symbols_t *symbol_at(unsigned index) {
    return memory_place((uint16_t)saving.handles[index].integer);
}

static bool is_saved_anew(const saved_record_t *record) {
    for (unsigned i = 0; i < saving.count; i++) {
        const symbols_t *symbol = symbol_at(i);
        if (symbol->length == record->name_length &&
            memcmp(symbol->name, record->name, symbol->length) == 0) {
            return true;
        }
    }
    return false;
}

static void copy_old(void) {
    saved_record_t record;
    uint8_t bytes[CHUNK];
    while (read_record(saving.old, &record)) {
        bool keep = !is_saved_anew(&record);
        if (keep) {
            write(&record, sizeof record);
        }
        for (uint32_t left = record.size; left > 0;) {
            uint32_t part = left < CHUNK ? left : CHUNK;
            read_exactly(saving.old, bytes, part);
            if (keep) {
                write(bytes, part);
            }
            left -= part;
        }
    }
}

static void save(void) {
    check(files_begin_replacement(FILE_NAME, &saving.new));
    saving.crc = 0;
    if (open_old()) {
        copy_old();
        files_close(saving.old);
        saving.old = -1;
    }
    saved_record_t record;
    for (unsigned i = 0; i < saving.count; i++) {
        const void *values;
        saved_record_describe(symbol_at(i), &record, &values);
        write(&record, sizeof record);
        write(values, record.size);
    }
    memset(&record, 0, sizeof record);
    record.size = saving.crc;
    write(&record, sizeof record);
    int complete = saving.new;
    saving.new = -1;
    check(files_commit_replacement(complete, FILE_NAME));
}

void saved_variables_save(const value_t *handles, unsigned count) {
    saving.handles = handles;
    saving.count = count;
    with_files(save);
}

// ---- Restoring ----------------------------------------------------------------------------------

static void restore(void) {
    saved_record_t record;
    if (!open_old()) {
        return;
    }
    while (read_record(saving.old, &record)) {
        void *values;
        saved_record_find(&record, &values);
        read_exactly(saving.old, values, record.size);
    }
}

void saved_variables_restore(void) {
    with_files(restore);
}

void saved_variables_clear(void) {
    files_entry_t entry;
    if (files_info(FILE_NAME, &entry) == ERR_OK) {
        check(files_remove(FILE_NAME));
    }
}
