// What was changed last: records one behind the other, each with the bytes that were taken out in
// front of it. When the memory is full the oldest half is forgotten. Context: main loop.
#include "editor_undo.h"

#include <stdint.h>
#include <string.h>

#include "editor_text.h"

typedef struct {
    uint32_t place;
    uint32_t inserted;
    uint32_t erased; // bytes in front of this record
    uint32_t step;
} record_t;

static struct {
    char *bytes;
    size_t size;
    size_t used;
    uint32_t step;
} undo;

void editor_undo_start(void *memory, size_t size) {
    undo.bytes = memory;
    undo.size = size;
    undo.used = 0;
    undo.step = 0;
}

void editor_undo_new_step(void) {
    undo.step++;
}

// The record that ends at `end`; it may lie at any address.
static record_t record_at(size_t end) {
    record_t record;
    memcpy(&record, undo.bytes + end - sizeof record, sizeof record);
    return record;
}

static size_t start_of(size_t end) {
    return end - sizeof(record_t) - record_at(end).erased;
}

static void push(const record_t *record) {
    memcpy(undo.bytes + undo.used, record, sizeof *record);
    undo.used += sizeof *record;
}

// Forgets the oldest records until `size` more bytes fit. False if they never will.
static bool make_room(size_t size) {
    if (size > undo.size) {
        undo.used = 0;
        return false;
    }
    if (undo.used + size <= undo.size) {
        return true;
    }
    size_t keep = undo.size - size < undo.size / 2 ? undo.size - size : undo.size / 2;
    size_t start = undo.used; // of the oldest record that stays
    while (start > 0 && undo.used - start_of(start) <= keep) {
        start = start_of(start);
    }
    undo.used -= start;
    memmove(undo.bytes, undo.bytes + start, undo.used);
    return true;
}

void editor_undo_inserted(size_t place, size_t count) {
    if (undo.used > 0) {
        record_t last = record_at(undo.used);
        if (last.step == undo.step && last.erased == 0 && last.place + last.inserted == place) {
            last.inserted += (uint32_t)count;
            undo.used -= sizeof last;
            push(&last);
            return;
        }
    }
    record_t record = {(uint32_t)place, (uint32_t)count, 0, undo.step};
    if (make_room(sizeof record)) {
        push(&record);
    }
}

void editor_undo_erasing(size_t place, size_t count) {
    record_t record = {(uint32_t)place, 0, (uint32_t)count, undo.step};
    if (make_room(count + sizeof record)) {
        editor_text_copy(place, count, undo.bytes + undo.used);
        undo.used += count;
        push(&record);
    }
}

static bool take_back(const record_t *record, size_t end) {
    if (record->erased != 0) {
        const char *bytes = undo.bytes + end - sizeof *record - record->erased;
        return editor_text_insert(record->place, bytes, record->erased);
    }
    editor_text_erase(record->place, record->inserted);
    return true;
}

bool editor_undo_step(size_t *place, bool *complete) {
    *complete = true;
    if (undo.used == 0) {
        return false;
    }
    uint32_t step = record_at(undo.used).step;
    while (undo.used > 0 && record_at(undo.used).step == step) {
        record_t record = record_at(undo.used);
        if (!take_back(&record, undo.used)) {
            *complete = false;
            return true;
        }
        *place = record.place + record.erased;
        undo.used = start_of(undo.used);
    }
    undo.step = step + 1;
    return true;
}
